#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "engine/core/npy.h"
#include "tests/fuzz/fuzz_expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    palp::fuzzRefusals([&] {
        const palp::NodeField field = palp::parseNpy(stream, size, "fuzz");
        for (const double value : field.values()) palp::fuzzExpect(std::isfinite(value));
    });
    return 0;
}
