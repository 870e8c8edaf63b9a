#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "engine/core/contract.h"
#include "engine/session/scene.h"

namespace {

void expect(bool holds)
{
    if (!holds) std::abort();
}

/// What must hold of every scene that is accepted, and that its own text gives it back.
void check(const palp::Scene& scene)
{
    const palp::PatchSettings& p = scene.patch;
    expect(!scene.cloud.empty() && p.window > 0 && p.cells >= 2 && p.cells % 2 == 0 && scene.material.thickness > 0);
    expect(scene.material.poissonRatio < 0.5 && p.foundation >= 0 && p.footprintRadius > 0);
    expect(scene.maxForce > 0 && scene.deformationRate > 0 && scene.dynamicFriction <= scene.staticFriction);
    expect(std::isfinite(scene.startHeight));
    if (scene.place) expect(std::isfinite(scene.place->x + scene.place->y + scene.place->z));
    const palp::Scene again = palp::parseScene(palp::sceneJson(scene), "again", ".");
    expect(palp::sceneJson(again) == palp::sceneJson(scene));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        check(palp::parseScene(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz", "."));
    } catch (const palp::Error&) {
        return 0; // a refusal is a right answer
    }
    return 0;
}
