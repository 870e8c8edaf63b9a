#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/session/scene.h"

namespace palp {

/// A number of a scene that may change while one touches: how a slider shows it.
struct SceneNumber {
    std::string_view key; ///< of sceneKeys()
    const char*      label;
    const char*      unit;        ///< as the number is shown and sent; empty for none
    double           perUnit;     ///< SI units in one of these
    double           least, most; ///< of the slider, in `unit`: narrower than what a scene takes
    bool             logarithmic;
    int              decimals;
    double           step;      ///< values are multiples of it, in `unit`; 0: any
    double (*of)(const Scene&); ///< the value now, SI
};

/// A value of a scene that is one of a few names.
struct SceneChoice {
    std::string_view         key;
    const char*              label;
    std::vector<const char*> options;
    std::string (*of)(const Scene&); ///< the value now, as an option is spelt
};

/// What is shown together, in the order in which it is shown.
struct SceneControls {
    std::vector<SceneNumber> numbers;
    std::vector<SceneChoice> choices;
    bool                     edges = false; ///< the edges of the window belong here
};

/// All that may change while one touches, but for the law of stiffness and the edges: a text, and four names.
[[nodiscard]] std::span<const SceneControls> sceneControls();

/// A number as a wish or a flag says it: "4 mm".
[[nodiscard]] std::string wishText(const SceneNumber& number, double shown);

/// A law of stiffness to start from, from the least to the largest modulus of the cloud.
/// \param law  constant, linear, hyperbolic or gaussian
[[nodiscard]] std::string lawPreset(std::string_view law, const Scene& scene, const PointCloud& cloud);

} // namespace palp
