#include "device/falcon/falcon_codec.h"

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "device/haptic_device.h"

namespace palp {
namespace {

constexpr auto kRed = std::uint8_t(DeviceLight::red), kGreen = std::uint8_t(DeviceLight::green),
               kBlue = std::uint8_t(DeviceLight::blue);

std::vector<std::uint8_t> bytesOf(std::string_view text)
{
    return {text.begin(), text.end()};
}

std::span<const std::uint8_t, 16> packetAt(const std::vector<std::uint8_t>& bytes, std::size_t at)
{
    return std::span<const std::uint8_t, 16>(bytes.data() + at, 16);
}

std::vector<FalconReply> allOf(FalconParser& parser)
{
    std::vector<FalconReply> replies;
    while (const auto reply = parser.next()) replies.push_back(*reply);
    return replies;
}

void append(std::vector<std::uint8_t>& bytes, const FalconPacket& packet)
{
    bytes.insert(bytes.end(), packet.begin(), packet.end());
}

FalconReply replyOf(int n) // each n another one
{
    return {{std::int16_t(n), std::int16_t(-n), std::int16_t(3 * n)}, std::uint8_t(n & 15), std::uint8_t(n & 7)};
}

TEST(FalconCodec, CommandsAreTheBytesThatTheVendorsDriverSends)
{
    // The first two by hand; the middle two captured from the vendor's driver; the last two by hand, extremes.
    const std::pair<const char*, FalconCommand> golden[] = {
        {"<AAAAAAAAAAAAAA>", {}},
        {"<AAAAAAAAAAAADA>", {{}, true, kGreen}},
        {"<JFNPBOJAKLIPEA>", {{-679, 2529, -1862}, false, kBlue}},
        {"<FJCALNCAOPCAEA>", {{661, 731, 766}, false, kBlue}},
        {"<IODAIBMPPPPAJA>", {{1000, -1000, 4095}, true, kRed}},
        {"<BAAPBAAAPPPPBA>", {{-4095, 1, -1}, true, 0}},
    };

    for (const auto& [text, command] : golden) {
        const FalconPacket packet = encode(command);
        EXPECT_EQ(std::string(packet.begin(), packet.end()), text);
        const auto decoded = decodeCommand(packetAt(bytesOf(text), 0));
        ASSERT_TRUE(decoded) << text;
        EXPECT_EQ(*decoded, command) << text;
    }
}

TEST(FalconCodec, ASilencedCommandIsTheSameWithoutItsForce)
{
    FalconPacket packet = encode(FalconCommand{{661, 0, 0}, true, kBlue});
    EXPECT_TRUE(kFalconZero.pushes(packet));
    kFalconZero.silence(packet);
    EXPECT_FALSE(kFalconZero.pushes(packet));
    EXPECT_EQ(packet, encode(FalconCommand{{}, true, kBlue})) << "the light stays";
    EXPECT_FALSE(kFalconZero.pushes(encode(FalconCommand{{}, true, kRed})));

    // What is no command, as firmware that is uploaded, is left alone: another start, end or length.
    for (const char* text : {"?FJCALNCAOPCAEA>", "<FJCALNCAOPCAEA?", "<FJCALNCAOPCAE>", "<FJCALNCAOPCAEAA>"}) {
        std::vector<std::uint8_t> bytes = bytesOf(text);
        EXPECT_FALSE(kFalconZero.pushes(bytes)) << text;
        kFalconZero.silence(bytes);
        EXPECT_EQ(bytes, bytesOf(text));
    }
}

TEST(FalconCodec, RepliesAreReadAsTheDeviceMeansThem)
{
    const std::vector<std::uint8_t> first{0x3C, 0x4D, 0x50, 0x4E, 0x50, 0x4D, 0x50, 0x4E,
                                          0x50, 0x4D, 0x50, 0x4E, 0x50, 0xB5, 0x41, 0x3E},
        second{0x3C, 0x4C, 0x48, 0x41, 0x41, 0x49, 0x44, 0x4F, 0x50, 0x46, 0x42, 0x44, 0x41, 0xBA, 0x41, 0x3E};
    const FalconReply centre{{-516, -516, -516}, 4, 7}, sides{{123, -456, 789}, 9, 7};

    EXPECT_EQ(decodeReply(packetAt(first, 0)), centre);
    EXPECT_EQ(decodeReply(packetAt(second, 0)), sides);
    const FalconPacket again = encode(sides);
    EXPECT_EQ(std::vector<std::uint8_t>(again.begin(), again.end()), second);
    EXPECT_TRUE(centre.homed());
    EXPECT_FALSE((FalconReply{{}, 0, 5}).homed()) << "leg 2 is missing";
}

TEST(FalconCodec, EveryNumberAndEveryFlagComesBack)
{
    for (int n = -32768; n <= 32767; ++n) {
        const FalconCommand command{
            {std::int16_t(n), std::int16_t(-n), std::int16_t(n ^ 0x5A5A)}, n % 2 == 0, std::uint8_t(n & 7)};
        ASSERT_EQ(decodeCommand(encode(command)), command) << n;
        ASSERT_EQ(decodeReply(encode(replyOf(n))), replyOf(n)) << n;
    }
}

TEST(FalconCodec, AByteOutsideTheRangeOfItsPlaceIsNoPacket)
{
    const FalconPacket good = encode(FalconReply{});
    for (std::size_t place = 0; place < good.size(); ++place) {
        for (int byte = 0; byte < 256; ++byte) {
            FalconPacket packet = good;
            packet[place]       = std::uint8_t(byte);

            const bool fits = place == 0    ? byte == '<'
                              : place == 15 ? byte == '>'
                              : place == 14 ? byte >= 0x41
                              : place == 13 ? byte >= 0x41 && byte <= 0xC0
                                            : byte >= 0x41 && byte <= 0x50;
            EXPECT_EQ(decodeReply(packet).has_value(), fits) << "place " << place << ", byte " << byte;
            EXPECT_EQ(decodeCommand(packet).has_value(), fits && (place != 13 || byte <= 0x50))
                << "place " << place << ", byte " << byte;
        }
    }
}

TEST(FalconParser, FindsRepliesHoweverTheStreamIsCut)
{
    std::vector<std::uint8_t> stream;
    for (int n = 0; n < 20; ++n) append(stream, encode(replyOf(n)));

    for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
        FalconParser parser;
        for (std::size_t at = 0; at < stream.size(); at += piece)
            parser.feed({stream.data() + at, std::min(piece, stream.size() - at)});

        const auto replies = allOf(parser);
        ASSERT_EQ(replies.size(), 20u) << "pieces of " << piece;
        for (int n = 0; n < 20; ++n) EXPECT_EQ(replies[std::size_t(n)], replyOf(n));
        EXPECT_EQ(parser.skipped(), 0u);
    }
}

TEST(FalconParser, ARuntCostsItselfOnly)
{
    FalconParser              parser;
    std::vector<std::uint8_t> stream;
    append(stream, encode(replyOf(1)));
    append(stream, encode(replyOf(2)));
    stream.resize(14 + 16); // as devices were seen to do: 14 bytes of a packet, then the next one
    append(stream, encode(replyOf(3)));

    parser.feed(stream);

    EXPECT_EQ(allOf(parser), (std::vector<FalconReply>{replyOf(1), replyOf(3)}));
    EXPECT_EQ(parser.skipped(), 14u);
}

TEST(FalconParser, AGainedByteCostsOnePacket)
{
    for (std::size_t place = 1; place < 16; ++place) {
        FalconParser              parser;
        std::vector<std::uint8_t> stream;
        append(stream, encode(replyOf(1)));
        append(stream, encode(replyOf(2)));
        stream.insert(stream.begin() + std::ptrdiff_t(place), std::uint8_t{0x00});

        parser.feed(stream);

        EXPECT_EQ(allOf(parser), std::vector<FalconReply>{replyOf(2)}) << "at place " << place;
        EXPECT_EQ(parser.skipped(), 17u);
    }
}

TEST(FalconParser, IsInStepAgainAfterAtMost31Bytes)
{
    std::vector<std::uint8_t> stream;
    for (int n = 0; n < 3; ++n) append(stream, encode(replyOf(n)));

    for (std::size_t start = 0; start < 16; ++start) { // where the link comes up
        FalconParser parser;
        std::size_t  taken = 0;
        while (!parser.next()) parser.feed({&stream.at(start + taken++), 1});
        EXPECT_LE(taken, 31u);
        EXPECT_EQ(taken, start == 0 ? 16u : 32u - start);
    }
}

TEST(FalconParser, KeepsTheNewestRepliesWhenNobodyAsks)
{
    FalconParser              parser;
    std::vector<std::uint8_t> stream;
    for (int n = 0; n < 100; ++n) append(stream, encode(replyOf(n)));

    parser.feed(stream);

    const auto replies = allOf(parser);
    ASSERT_EQ(replies.size(), FalconParser::kWaiting);
    EXPECT_EQ(replies.front(), replyOf(100 - int(FalconParser::kWaiting)));
    EXPECT_EQ(replies.back(), replyOf(99));
    EXPECT_EQ(parser.skipped(), (100 - FalconParser::kWaiting) * 16);
}

/// A stream of at most 64 bytes: noise, or packets with a few bytes changed, lost or gained.
std::vector<std::uint8_t> streamOf(std::mt19937_64& random)
{
    std::vector<std::uint8_t> stream;
    if (random() % 4 == 0) {
        stream.resize(random() % 65);
        for (auto& byte : stream) byte = std::uint8_t(random());
        return stream;
    }
    const std::size_t packets = 1 + random() % 3;
    for (std::size_t n = 0; n < packets; ++n) append(stream, encode(replyOf(int(random() % 65536) - 32768)));
    for (std::size_t faults = random() % 4; faults > 0; --faults) {
        const auto at = stream.begin() + std::ptrdiff_t(random() % stream.size());
        // Brackets and letters more often than others: they come closest to a packet.
        const std::uint8_t bytes[] = {0x3C, 0x3E, std::uint8_t(0x41 + random() % 16), std::uint8_t(random())};
        switch (random() % 3) {
        case 0:
            *at = bytes[random() % 4];
            break;
        case 1:
            stream.erase(at);
            break;
        default:
            stream.insert(at, bytes[random() % 4]);
        }
    }
    return stream;
}

// A million streams, one after the other through one parser. Beside it a search by brute force: a packet is wherever 16
// bytes of the whole stream decode. Both must find the same replies, and every byte must be accounted for.
TEST(FalconParser, FindsInNoiseExactlyThePacketsThatAreThere)
{
    std::mt19937_64           random(20260101);
    FalconParser              parser;
    std::vector<std::uint8_t> past; // the last 15 bytes of the streams so far, and the present one
    std::uint64_t             fed = 0, found = 0;
    for (int n = 0; n < 1'000'000; ++n) {
        const std::vector<std::uint8_t> stream = streamOf(random);
        std::size_t                     cut    = stream.empty() ? 0 : random() % stream.size();
        parser.feed({stream.data(), cut});
        parser.feed({stream.data() + cut, stream.size() - cut});
        fed += stream.size();

        past.insert(past.end(), stream.begin(), stream.end());
        for (std::size_t at = 0; at + 16 <= past.size(); ++at) {
            if (past[at] != '<') continue;
            const auto expected = decodeReply(packetAt(past, at));
            if (!expected) continue;
            ASSERT_EQ(parser.next(), expected) << "stream " << n;
            ++found;
        }
        ASSERT_FALSE(parser.next()) << "stream " << n;
        if (past.size() > 15) past.erase(past.begin(), past.end() - 15);
        const std::uint64_t held = fed - 16 * found - parser.skipped();
        ASSERT_LT(held, 16u) << "stream " << n;
    }
    EXPECT_GT(found, 500'000u) << "the streams should not be all noise";
}

} // namespace
} // namespace palp
