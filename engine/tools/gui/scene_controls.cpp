#include "engine/tools/gui/scene_controls.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "engine/core/extremes.h"
#include "engine/session/scene_place.h"

namespace palp {
namespace {

SceneControls controlsOf(KeyControl::Panel panel)
{
    SceneControls controls{{}, {}, panel == KeyControl::Panel::patch};
    for (const SceneKey& key : sceneKeys())
        if (key.control && key.control->panel == panel)
            (key.control->least < key.control->most ? controls.sliders : controls.lists).push_back(&key);
    return controls;
}

} // namespace

std::span<const SceneControls> sceneControls()
{
    static const std::array kControls{controlsOf(KeyControl::Panel::material), controlsOf(KeyControl::Panel::patch),
                                      controlsOf(KeyControl::Panel::servo)};
    return kControls;
}

std::vector<std::string> optionsOf(const SceneKey& key)
{
    if (key.kind == SceneKey::Kind::word) return key.words;
    return {"1e-2", "1e-3", "1e-4", "1e-5", "1e-6"}; // a number without a slider: the tolerance
}

std::string optionNow(const SceneKey& key, const Scene& scene)
{
    if (key.kind == SceneKey::Kind::word) {
        const std::string quoted = key.write(scene);
        return quoted.substr(1, quoted.size() - 2);
    }
    char text[16];
    std::snprintf(text, sizeof text, "%.0e", key.number(scene)); // "1e-04"
    std::string decade(text);
    if (const auto zero = decade.find("e-0"); zero != std::string::npos) decade.erase(zero + 2, 1);
    return decade;
}

std::string wishText(const SceneKey& key, double shown)
{
    const KeyControl& control = *key.control;
    if (control.step > 0) shown = control.step * std::round(shown / control.step);
    char text[64];
    std::snprintf(text, sizeof text, "%.*g%s%s", 6, shown, *control.unit ? " " : "", control.unit);
    return text;
}

double contrastIn(const PointCloud& cloud)
{
    const Extremes found = extremesOf(cloud.stiffness());
    return found.most > 1.05 * found.least ? found.most : 10 * found.least;
}

std::string lawPreset(std::string_view law, const Scene& scene, const PointCloud& cloud)
{
    const Extremes  found    = extremesOf(cloud.stiffness());
    const Material& material = scene.material;
    const bool      isD      = cloud.kind() == StiffnessKind::rigidity;
    const double    low      = isD ? material.modulus(found.least) : found.least, // [Pa]
        high                 = isD ? material.modulus(found.most) : found.most;   // [Pa]
    const glm::dvec3 place   = placeOf(scene, cloud);
    const double     softest = low, stiffest = low * contrastIn(cloud) / found.least;
    const int        length = int(law.size());
    char             text[256];
    if (law == "constant")
        std::snprintf(text, sizeof text, "constant:value=%.3g", std::sqrt(low * high));
    else if (law == "gaussian")
        std::snprintf(text, sizeof text, "gaussian:from=%.3g,to=%.3g,centre=%.4g;%.4g;%.4g,sigma=%.3g", softest,
                      stiffest, place.x, place.y, place.z, 2 * scene.patch.footprintRadius);
    else
        std::snprintf(text, sizeof text, "%.*s:from=%.3g,to=%.3g,axis=x", length, law.data(), softest, stiffest);
    return text;
}

} // namespace palp
