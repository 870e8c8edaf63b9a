#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "device/falcon/falcon_codec.h"
#include "tests/fuzz/fuzz_expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::FalconParser parser;
    std::uint64_t      replies = 0;
    for (std::size_t at = 0; at < size; at += 13) {
        parser.feed({data + at, std::min<std::size_t>(13, size - at)});
        while (const auto reply = parser.next()) {
            ++replies;
            palp::fuzzExpect(palp::decodeReply(palp::encode(*reply)) == reply);
            palp::fuzzExpect(reply->homedLegs < 8 && reply->grip < 16);
        }
    }
    ++(replies > 0 ? palp::fuzzVerdicts.accepted : palp::fuzzVerdicts.refused);
    palp::fuzzExpect(replies * 16 + parser.skipped() <= size);

    // Whatever a packet to the arm says: silenced, it does not push.
    palp::FalconPacket packet{};
    std::copy_n(data, std::min(size, packet.size()), packet.begin());
    if (const auto command = palp::decodeCommand(packet))
        palp::fuzzExpect(palp::decodeCommand(palp::encode(*command)) == command);
    palp::kFalconZero.silence(packet);
    palp::fuzzExpect(!palp::kFalconZero.pushes(packet));
    return 0;
}
