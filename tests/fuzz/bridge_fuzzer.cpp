#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/geometric.hpp>

#include "device/hid/bridge_report.h"
#include "device/hid/bridge_stream.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

/// What must hold of every report that is believed: finite, within its fields, and it is written as it was read.
void check(const palp::BridgeBytes& report)
{
    palp::BridgeAnswer answer;
    const bool         good = palp::decode(report, answer) == palp::BridgeVerdict::good;
    ++(good ? palp::fuzzVerdicts.accepted : palp::fuzzVerdicts.refused);
    if (!good) return;
    palp::fuzzExpect(
        std::isfinite(glm::length(answer.position) + glm::length(answer.velocity) + glm::length(answer.rendered)));
    palp::fuzzExpect(std::abs(glm::length(answer.orientation) - 1) < 1e-2 && answer.buttonCount <= 32);
    palp::BridgeAnswer again;
    palp::fuzzExpect(palp::decode(palp::encode(answer), again) == palp::BridgeVerdict::good);
    palp::fuzzExpect(again.position == answer.position && again.sequence == answer.sequence);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::BridgeStream stream;
    for (std::size_t at = 0; at < size; at += 17) {
        stream.feed({data + at, std::min<std::size_t>(17, size - at)});
        while (const auto report = stream.next()) check(*report);
    }
    // A checksum that is right lets the fuzzer past it.
    palp::BridgeBytes report{};
    std::copy_n(data, std::min(size, report.size()), report.begin());
    const std::uint16_t sum       = palp::bridgeChecksum(std::span(report).first(palp::kBridgeSize - 2));
    report[palp::kBridgeSize - 2] = std::uint8_t(sum);
    report[palp::kBridgeSize - 1] = std::uint8_t(sum >> 8U);
    check(report);
    return 0;
}
