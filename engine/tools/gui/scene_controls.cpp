#include "engine/tools/gui/scene_controls.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "engine/core/extremes.h"

namespace palp {
namespace {

using S = Scene;

std::vector<SceneNumber> materialNumbers()
{
    return {
        {"thickness", "thickness", "mm", 1e-3, 0.1, 20, true, 2, 0, [](const S& s) { return s.material.thickness; }},
        {"poisson", "Poisson's ratio", "", 1, 0, 0.49, false, 2, 0, [](const S& s) { return s.material.poissonRatio; }},
        {"foundation", "foundation", "MPa/m", 1e6, 0, 100, true, 2, 0, [](const S& s) { return s.patch.foundation; }},
    };
}

std::vector<SceneNumber> patchNumbers()
{
    return {
        {"window", "window", "mm", 1e-3, 5, 200, true, 1, 0, [](const S& s) { return s.patch.window; }},
        {"cells", "cells a side", "", 1, 16, 256, true, 0, 2, [](const S& s) { return double(s.patch.cells); }},
        {"footprint_radius", "fingertip", "mm", 1e-3, 0.5, 20, true, 2, 0,
         [](const S& s) { return s.patch.footprintRadius; }},
    };
}

std::vector<SceneChoice> patchChoices()
{
    return {
        {"map",
         "map",
         {"lambert-azimuthal", "lambert-cylindrical", "gall-peters"},
         [](const S& s) { return std::string(name(s.patch.map)); }},
        {"sampling",
         "sampling",
         {"log-mean", "nearest"},
         [](const S& s) { return std::string(name(s.patch.sampling)); }},
        {"tolerance",
         "tolerance",
         {"1e-2", "1e-3", "1e-4", "1e-5", "1e-6"},
         [](const S& s) {
             char text[16];
             std::snprintf(text, sizeof text, "%.0e", s.patch.tolerance); // "1e-04"
             std::string short_(text);
             if (const auto zero = short_.find("e-0"); zero != std::string::npos) short_.erase(zero + 2, 1);
             return short_;
         }},
    };
}

std::vector<SceneNumber> servoNumbers()
{
    return {
        {"deformation_rate", "plate's rate", "Hz", 1, 5, 240, true, 0, 1, [](const S& s) { return s.deformationRate; }},
        {"static_friction", "friction at rest", "", 1, 0, 2, false, 2, 0, [](const S& s) { return s.staticFriction; }},
        {"dynamic_friction", "friction, sliding", "", 1, 0, 2, false, 2, 0,
         [](const S& s) { return s.dynamicFriction; }},
        {"max_force", "most force", "N", 1, 0.1, 8, false, 1, 0, [](const S& s) { return s.maxForce; }},
        {"stiffness_cap", "most stiffness", "N/m", 1, 50, 2000, true, 0, 1, [](const S& s) { return s.stiffnessCap; }},
    };
}

std::vector<SceneChoice> servoChoices()
{
    return {
        {"force_law", "force law", {"series", "paper"}, [](const S& s) { return std::string(name(s.patch.forceLaw)); }},
        {"hand_over",
         "hand-over",
         {"table", "hold", "blend"},
         [](const S& s) { return std::string(name(s.handOver)); }},
        {"proxy", "proxy", {"hybrid", "sphere", "plain-sphere"}, [](const S& s) { return std::string(name(s.proxy)); }},
    };
}

} // namespace

std::span<const SceneControls> sceneControls()
{
    static const std::array kControls = {
        SceneControls{materialNumbers(), {}},
        SceneControls{patchNumbers(), patchChoices(), true},
        SceneControls{servoNumbers(), servoChoices()},
    };
    return kControls;
}

std::string wishText(const SceneNumber& number, double shown)
{
    if (number.step > 0) shown = number.step * std::round(shown / number.step);
    char text[64];
    std::snprintf(text, sizeof text, "%.*g%s%s", 6, shown, *number.unit ? " " : "", number.unit);
    return text;
}

std::string lawPreset(std::string_view law, const Scene& scene, const PointCloud& cloud)
{
    const Extremes  found    = extremesOf(cloud.stiffness());
    const Material& material = scene.material;
    const bool      isD      = cloud.kind() == StiffnessKind::rigidity;
    const double    low      = isD ? material.modulus(found.least) : found.least, // [Pa]
        high                 = isD ? material.modulus(found.most) : found.most;   // [Pa]
    const double softest = low, stiffest = high > 1.05 * low ? high : 10 * low;
    const int    length = int(law.size());
    char         text[256];
    if (law == "constant")
        std::snprintf(text, sizeof text, "constant:value=%.3g", std::sqrt(low * high));
    else if (law == "gaussian")
        std::snprintf(text, sizeof text, "gaussian:from=%.3g,to=%.3g,centre=%.4g;%.4g;%.4g,sigma=%.3g", softest,
                      stiffest, scene.place.x, scene.place.y, scene.place.z, 2 * scene.patch.footprintRadius);
    else
        std::snprintf(text, sizeof text, "%.*s:from=%.3g,to=%.3g,axis=x", length, law.data(), softest, stiffest);
    return text;
}

} // namespace palp
