#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "engine/core/contract.h"
#include "engine/core/npy.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
    try {
        const palp::NodeField field = palp::parseNpy(stream, size, "fuzz");
        for (const double value : field.values())
            if (!std::isfinite(value)) std::abort();
    } catch (const palp::Error&) {
        return 0; // a refusal is a right answer
    }
    return 0;
}
