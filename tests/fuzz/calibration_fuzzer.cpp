#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "device/falcon/falcon_constants.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

/// What must hold of every calibration that is believed: what it changes of a force is bounded.
void check(const palp::FalconConstants& found)
{
    using Motors = palp::FalconMotors;
    palp::fuzzExpect(found.countsPerTorque >= Motors::kLeastCountsPerTorque &&
                     found.countsPerTorque <= Motors::kMostCountsPerTorque);
    palp::fuzzExpect(found.armMass >= 0 && found.armMass <= palp::kMostArm && found.date.size() == 10);
    palp::fuzzExpect(!found.hold || (*found.hold >= 0 && *found.hold <= palp::kMostHold));
}

} // namespace

// The files of a Falcon, one after another, each ended by a zero.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    for (std::string_view rest(reinterpret_cast<const char*>(data), size); !rest.empty();) {
        const std::string_view one = rest.substr(0, rest.find('\0'));
        rest.remove_prefix(std::min(rest.size(), one.size() + 1));
        palp::fuzzRefusals([&] { check(palp::parseFalconConstants(one, "fuzz", "FZ1")); });
    }
    return 0;
}
