#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/session/scene_keys.h"

namespace palp {

/// What is shown together, in the order in which it is shown: keys of the table that have a KeyControl.
struct SceneControls {
    std::vector<const SceneKey*> sliders;
    std::vector<const SceneKey*> lists;
    bool                         edges = false; ///< the edges of the window belong here
};

/// All that may change while one touches, but for the law of stiffness and the edges: a text, and four names.
[[nodiscard]] std::span<const SceneControls> sceneControls();

/// The values that a list offers, and the one that the scene has now.
[[nodiscard]] std::vector<std::string> optionsOf(const SceneKey& key);
[[nodiscard]] std::string              optionNow(const SceneKey& key, const Scene& scene);

/// A number in the unit of its slider, as a wish or a flag says it: "4 mm".
[[nodiscard]] std::string wishText(const SceneKey& key, double shown);

/// A law of stiffness to start from, from the least to the largest modulus of the cloud.
/// \param law  constant, linear, hyperbolic or gaussian
[[nodiscard]] std::string lawPreset(std::string_view law, const Scene& scene, const PointCloud& cloud);

} // namespace palp
