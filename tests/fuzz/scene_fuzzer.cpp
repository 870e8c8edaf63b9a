#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/session/scene.h"
#include "tests/fuzz/fuzz_expect.h"

namespace {

/// What must hold of every scene that is accepted, and that its own text gives it back.
void check(const palp::Scene& scene)
{
    const palp::PatchSettings& p = scene.patch;
    palp::fuzzExpect(!scene.cloud.empty() && p.window > 0 && p.cells >= 2 && p.cells % 2 == 0 &&
                     scene.material.thickness > 0);
    palp::fuzzExpect(scene.material.poissonRatio < 0.5 && p.foundation >= 0 && p.footprintRadius > 0);
    palp::fuzzExpect(scene.maxForce > 0 && scene.deformationRate > 0 && scene.dynamicFriction <= scene.staticFriction);
    palp::fuzzExpect(std::isfinite(scene.startHeight));
    if (scene.place) palp::fuzzExpect(std::isfinite(scene.place->x + scene.place->y + scene.place->z));
    const palp::Scene again = palp::parseScene(palp::sceneJson(scene), "again", ".");
    palp::fuzzExpect(palp::sceneJson(again) == palp::sceneJson(scene));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    palp::fuzzRefusals(
        [&] { check(palp::parseScene(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz", ".")); });
    return 0;
}
