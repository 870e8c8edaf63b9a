#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "device/hid/space_mouse_report.h"
#include "tests/fuzz/fuzz_expect.h"

// Reports one after another, each behind its length.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::SpaceMouseCounts counts;
    for (std::span<const std::uint8_t> rest(data, size); !rest.empty();) {
        const auto report                   = rest.subspan(1, std::min<std::size_t>(rest[0], rest.size() - 1));
        rest                                = rest.subspan(1 + report.size());
        const palp::SpaceMouseCounts before = counts;
        const bool                   taken  = palp::takeSpaceMouseReport(report, counts);
        ++(taken ? palp::fuzzVerdicts.accepted : palp::fuzzVerdicts.refused);
        if (!taken) palp::fuzzExpect(counts.axes == before.axes && counts.buttons == before.buttons);
        for (const int axis : counts.axes) palp::fuzzExpect(std::abs(axis) <= palp::kMostSpaceMouseCounts);
    }
    return 0;
}
