#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "engine/session/scene.h"
#include "engine/session/scene_keys.h"
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

/// A command line knows no other options.
bool isKey(const std::string& name)
{
    return std::ranges::find(palp::sceneKeys(), name, &palp::SceneKey::name) != palp::sceneKeys().end();
}

/// Returns the scene of a sheet with what a user states beside a file: lines "$PALPATE_THICKNESS=4 mm" are of the
/// environment, lines "thickness=4 mm" are options.
palp::Scene stated(std::string_view lines)
{
    std::map<std::string, std::string, std::less<>> environment;
    palp::SceneOverrides                            overrides;
    while (!lines.empty()) {
        std::string line(lines.substr(0, lines.find('\n')));
        lines.remove_prefix(std::min(lines.size(), line.size() + 1));
        line.resize(std::min(line.size(), line.find('\0'))); // neither can hold one
        const bool        ofEnvironment = line.starts_with('$');
        const std::size_t equals        = std::min(line.find('='), line.size());
        const std::string key           = line.substr(ofEnvironment, equals - ofEnvironment);
        auto&             texts         = ofEnvironment ? environment : overrides.flags;
        if (ofEnvironment || isKey(key)) texts[key] = line.substr(std::min(equals + 1, line.size()));
    }
    overrides.flagsInLengthUnit = overrides.flags.contains("length_unit");
    overrides.environment       = [&](const char* name) {
        const auto found = environment.find(name);
        return found == environment.end() ? nullptr : found->second.c_str();
    };
    return palp::parseScene(R"({"cloud": "sample:sheet"})", "fuzz", ".", overrides);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    palp::fuzzRefusals([&] {
        if (!text.starts_with('=')) return check(palp::parseScene(text, "fuzz", "."));
        const palp::Scene scene = stated(text.substr(1));
        check(scene);
        for (const auto format : {palp::ConfigFormat::text, palp::ConfigFormat::json})
            palp::fuzzExpect(!palp::printConfig(scene, format).empty());
    });
    return 0;
}
