#include <cmath>
#include <string_view>

#include "engine/tools/fit/probe_table.h"
#include "tests/fuzz/fuzz_expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::fuzzRefusals([&] {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        for (const auto& probe : palp::fuzzRead([&] { return palp::fit::parseProbes(text, "fuzz"); })) {
            palp::fuzzExpect(probe.depth.size() >= palp::fit::kFewestRows && probe.depth.size() == probe.force.size());
            palp::fuzzExpect(probe.time.empty() || probe.time.size() == probe.depth.size());
            palp::fuzzExpect(std::isfinite(probe.deepest()) && std::isfinite(probe.forceRange()));
        }
    });
    return 0;
}
