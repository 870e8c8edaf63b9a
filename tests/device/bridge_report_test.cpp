#include "device/hid/bridge_report.h"

#include <limits>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

// Packed by another program, from the table in device/README.md.
constexpr BridgeBytes kGoldenAnswer{0x01, 0x50, 0x42, 0x11, 0x34, 0x12, 0x17, 0x00, 0x05, 0x00, 0x00, 0x80, 0x39,
                                    0x30, 0x00, 0x00, 0xCE, 0xF6, 0xFE, 0xFF, 0xA0, 0x86, 0x01, 0x00, 0x06, 0xFF,
                                    0x00, 0x00, 0xDC, 0x05, 0xEF, 0xFC, 0x00, 0x40, 0x00, 0xC0, 0x00, 0x40, 0x00,
                                    0x40, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE, 0xFF, 0x24, 0xFA, 0x02, 0x00, 0xFF, 0x7F,
                                    0xC2, 0x01, 0x40, 0x1F, 0xE8, 0x03, 0x20, 0x4E, 0x04, 0xA0, 0x05, 0xF7};
constexpr BridgeBytes kGoldenCommand{0x02, 0x50, 0x42, 0x11, 0x02, 0x01, 0x03, 0x00, 0xE8, 0x03, 0x3C, 0xF6, 0x70,
                                     0x17, 0x32, 0x06, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                                     0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                                     0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                                     0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x63};

BridgeBytes withSum(BridgeBytes bytes)
{
    const std::uint16_t sum = bridgeChecksum(std::span(bytes).first(62));
    bytes[62]               = std::uint8_t(sum);
    bytes[63]               = std::uint8_t(sum >> 8);
    return bytes;
}

BridgeAnswer goldenAnswer()
{
    BridgeAnswer answer;
    answer.sequence         = 0x1234;
    answer.flags            = std::uint16_t(1 | 2 | 4 | 16);
    answer.buttons          = 0x80000005;
    answer.position         = {0.012345, -0.06789, 0.1};
    answer.velocity         = {-0.25, 0, 1.5};
    answer.gripper          = -0.785;
    answer.orientation      = glm::dquat(0.5, -0.5, 0.5, 0.5);
    answer.deviceTime       = 4294.967295;
    answer.command          = 0xFFFE;
    answer.rendered         = {-1.5, 0.002, 32.767};
    answer.workspaceRadius  = 0.045;
    answer.maximumForce     = 8;
    answer.maximumStiffness = 1000;
    answer.maximumDamping   = 20;
    answer.buttonCount      = 4;
    answer.ownDamping       = 3.2;
    return answer;
}

TEST(BridgeReport, ChecksumIsTheCatalogued) // CRC-16/CCITT-FALSE in every catalogue
{
    constexpr std::array<std::uint8_t, 9> kDigits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    EXPECT_EQ(bridgeChecksum(kDigits), 0x29B1);
}

TEST(BridgeReport, EncodesTheGoldenBytes)
{
    EXPECT_EQ(encode(goldenAnswer()), kGoldenAnswer);
    BridgeCommand command{.sequence = 0x0102, .enable = true, .home = true, .force = {1, -2.5, 6}, .watchdog = 0.05};
    command.lights = 6;
    EXPECT_EQ(encode(command), kGoldenCommand);
}

TEST(BridgeReport, DecodesTheGoldenBytes)
{
    BridgeAnswer answer;
    ASSERT_EQ(decode(kGoldenAnswer, answer), BridgeVerdict::good);
    const BridgeAnswer expected = goldenAnswer();
    const double       rounding = 1e-12;
    EXPECT_EQ(answer.sequence, expected.sequence);
    EXPECT_EQ(answer.flags, expected.flags);
    EXPECT_EQ(answer.buttons, expected.buttons);
    EXPECT_NEAR(glm::distance(answer.position, expected.position), 0, rounding);
    EXPECT_NEAR(glm::distance(answer.velocity, expected.velocity), 0, rounding);
    EXPECT_NEAR(answer.gripper, expected.gripper, rounding);
    EXPECT_NEAR(glm::length(answer.orientation - expected.orientation), 0, rounding)
        << "16384 for each part: equal parts, and normalized";
    EXPECT_NEAR(answer.deviceTime, expected.deviceTime, 1e-9) << "rounding at 4000 s";
    EXPECT_EQ(answer.command, expected.command);
    EXPECT_NEAR(glm::distance(answer.rendered, expected.rendered), 0, rounding);
    EXPECT_NEAR(answer.workspaceRadius, 0.045, rounding);
    EXPECT_NEAR(answer.maximumForce, 8, rounding);
    EXPECT_EQ(answer.maximumStiffness, 1000);
    EXPECT_NEAR(answer.maximumDamping, 20, rounding);
    EXPECT_EQ(answer.buttonCount, 4U);
    EXPECT_NEAR(answer.ownDamping, 3.2, rounding);

    BridgeCommand command;
    ASSERT_EQ(decode(kGoldenCommand, command), BridgeVerdict::good);
    EXPECT_EQ(command.sequence, 0x0102);
    EXPECT_TRUE(command.enable && command.home);
    EXPECT_NEAR(glm::distance(command.force, {1, -2.5, 6}), 0, rounding);
    EXPECT_NEAR(command.watchdog, 0.05, rounding);
    EXPECT_EQ(command.lights, 6);
}

TEST(BridgeReport, WhatIsSentArrivesWithinHalfAStep)
{
    std::mt19937                           random(11);
    std::uniform_real_distribution<double> wide(-1, 1);
    const auto                             vector = [&](double size) {
        return glm::dvec3(size * wide(random), size * wide(random), size * wide(random));
    };
    const auto within = [](const glm::dvec3& a, const glm::dvec3& b, double half) {
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(a[axis], b[axis], half * (1 + 1e-9)) << "half a step, rounding";
    };
    for (int n = 0; n < 20000; ++n) {
        BridgeAnswer sent;
        sent.sequence    = std::uint16_t(random());
        sent.flags       = std::uint16_t(random());
        sent.buttons     = std::uint32_t(random());
        sent.position    = vector(2000);
        sent.velocity    = vector(32.7);
        sent.rendered    = vector(32.7);
        sent.orientation = glm::normalize(glm::dquat(wide(random), vector(1)));
        sent.deviceTime  = 2147 * (1 + wide(random));
        BridgeAnswer got;
        ASSERT_EQ(decode(encode(sent), got), BridgeVerdict::good);
        EXPECT_EQ(got.sequence, sent.sequence);
        EXPECT_EQ(got.flags, sent.flags);
        EXPECT_EQ(got.buttons, sent.buttons);
        within(got.position, sent.position, 0.5e-6);
        within(got.velocity, sent.velocity, 0.5e-3);
        within(got.rendered, sent.rendered, 0.5e-3);
        EXPECT_NEAR(got.deviceTime, sent.deviceTime, 0.5e-6 * (1 + 1e-6)) << "half a step, rounding at 4000 s";
        if (sent.has(BridgeFlag::rotates)) {
            EXPECT_NEAR(glm::length(got.orientation - sent.orientation), 0, 4 * 0.5 / 32767)
                << "half a step in each of four parts, and their length";
        } else {
            EXPECT_EQ(got.orientation, glm::dquat(1, 0, 0, 0));
        }
    }
}

TEST(BridgeReport, WhatDoesNotFitEndsAtTheFieldsLimit)
{
    BridgeCommand command{.enable = true, .force = {1e9, -1e9, kNan}, .watchdog = 7}, got;
    ASSERT_EQ(decode(encode(command), got), BridgeVerdict::good);
    EXPECT_NEAR(got.force.x, 32.767, 1e-12) << "rounding; above all it does not wrap around";
    EXPECT_NEAR(got.force.y, -32.768, 1e-12) << "rounding";
    EXPECT_EQ(got.force.z, 0) << "what is no number";
    EXPECT_NEAR(got.watchdog, 0.255, 1e-12) << "rounding";

    for (double none : {0.0, -1.0, kNan}) {
        command.watchdog = none;
        ASSERT_EQ(decode(encode(command), got), BridgeVerdict::good);
        EXPECT_NEAR(got.watchdog, 1e-3, 1e-12) << none << ": a watchdog cannot be turned off, which 0 would mean";
    }
    command.watchdog = kInf;
    ASSERT_EQ(decode(encode(command), got), BridgeVerdict::good);
    EXPECT_NEAR(got.watchdog, 0.255, 1e-12) << "rounding";
    command.enable = false;
    ASSERT_EQ(decode(encode(command), got), BridgeVerdict::good);
    EXPECT_EQ(got.force, glm::dvec3(0)) << "no force without enable";
    const BridgeBytes bytes = encode(command); // nor on the wire, where a firmware may forget to look
    for (std::size_t n = 8; n < 14; ++n) EXPECT_EQ(bytes[n], 0) << "byte " << n;

    BridgeAnswer answer, back;
    answer.position   = {kInf, -1e9, 1e9};
    answer.deviceTime = 4294.967296 + 1;
    ASSERT_EQ(decode(encode(answer), back), BridgeVerdict::good);
    EXPECT_EQ(back.position.x, 0);
    EXPECT_NEAR(back.position.y, -2147.483648, 1e-9) << "rounding";
    EXPECT_NEAR(back.deviceTime, 1, 1e-9) << "the device's clock wraps around";
}

TEST(BridgeReport, NoMoreButtonsAreCountedThanTheirBits)
{
    for (const auto& [said, counted] : {std::pair{31U, 31U}, {32U, 32U}, {33U, 32U}, {1000U, 32U}}) {
        BridgeAnswer answer, got;
        answer.buttonCount = said;
        BridgeBytes bytes  = encode(answer);
        ASSERT_EQ(decode(bytes, got), BridgeVerdict::good);
        EXPECT_EQ(got.buttonCount, counted);
        if (said > 255) continue;
        EXPECT_EQ(bytes[60], counted);
        bytes[60] = std::uint8_t(said); // as a firmware might count them
        ASSERT_EQ(decode(withSum(bytes), got), BridgeVerdict::good);
        EXPECT_EQ(got.buttonCount, counted);
    }
}

TEST(BridgeReport, ASilencedCommandIsTheSameWithoutItsForce)
{
    BridgeCommand command;
    command.sequence   = 40;
    command.enable     = true;
    command.force      = {1, -2, 3};
    BridgeBytes report = encode(command);
    EXPECT_TRUE(kBridgeZero.pushes(report));

    kBridgeZero.silence(report);

    BridgeCommand found;
    ASSERT_EQ(decode(report, found), BridgeVerdict::good);
    EXPECT_FALSE(kBridgeZero.pushes(report));
    EXPECT_FALSE(found.enable);
    EXPECT_EQ(found.force, glm::dvec3(0));
    EXPECT_EQ(found.sequence, 40 + kBridgeZeroAhead) << "what the program still sends is old";
}

TEST(BridgeReport, OneFlippedBitIsSeen)
{
    for (std::size_t bit = 0; bit < 8 * kBridgeSize; ++bit) {
        BridgeBytes bytes = kGoldenAnswer;
        bytes[bit / 8]    = std::uint8_t(bytes[bit / 8] ^ 1 << (bit % 8));
        BridgeAnswer out;
        out.sequence = 77;
        EXPECT_NE(decode(bytes, out), BridgeVerdict::good) << "bit " << bit;
        EXPECT_EQ(out.sequence, 77) << "nothing is taken over";
    }
}

TEST(BridgeReport, GarbageIsRefused)
{
    std::mt19937                       random(3);
    std::uniform_int_distribution<int> byte(0, 255), length(0, 80);
    BridgeAnswer                       answer;
    BridgeCommand                      command;
    for (int n = 0; n < 100000; ++n) { // with the mark in place, so that the checksum is what refuses
        std::vector<std::uint8_t> report(std::size_t(n % 2 ? length(random) : 64));
        for (std::uint8_t& b : report) b = std::uint8_t(byte(random));
        if (report.size() > 3) std::copy_n(kGoldenAnswer.begin(), 4, report.begin());
        // One in 65536 has the right sum by chance; this seed none.
        EXPECT_NE(decode(report, answer), BridgeVerdict::good);
        EXPECT_EQ(decode(report, command), BridgeVerdict::notOurs);
    }
}

TEST(BridgeReport, LaterMinorVersionsAreUnderstoodOtherMajorOnesNot)
{
    BridgeAnswer out;
    BridgeBytes  later = kGoldenAnswer;
    later[3]           = 0x1F;
    later[61]          = 0xAB; // reserved in 1.0, a damping since
    EXPECT_EQ(decode(withSum(later), out), BridgeVerdict::good);
    later[3] = 0x20;
    EXPECT_EQ(decode(withSum(later), out), BridgeVerdict::otherVersion);
    EXPECT_EQ(decode(later, out), BridgeVerdict::otherVersion) << "wherever its checksum stands";
}

TEST(BridgeReport, AnOrientationThatIsNoneIsDamage)
{
    BridgeAnswer answer, out;
    answer.flags       = std::uint16_t(BridgeFlag::rotates);
    answer.orientation = glm::dquat(0, 0, 0, 0);
    EXPECT_EQ(decode(encode(answer), out), BridgeVerdict::damaged);
}

} // namespace
} // namespace palp
