#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "engine/core/volume_grid.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

void read(const std::string& bytes, palp::VolumeFormat format, const palp::VolumeSettings& settings)
{
    std::istringstream stream(bytes);
    palp::fuzzRefusals([&] {
        const palp::VolumeGrid grid   = palp::parseVolume(stream, bytes.size(), "fuzz", format, settings);
        const auto             middle = [&](int k) { return 0.5 * (grid.size()[std::size_t(k)] - 1); };
        const auto             value  = grid.at(grid.placeOf(middle(0), middle(1), middle(2)));
        palp::fuzzExpect(value.at != palp::VolumeGrid::At::inside || (value.value > 0 && std::isfinite(value.value)));
    });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    read(bytes, palp::VolumeFormat::nifti, {.lengthUnit = "mm"});
    read(bytes, palp::VolumeFormat::npy, {.spacing = glm::dvec3(1e-3)});
    return 0;
}
