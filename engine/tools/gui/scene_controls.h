#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/session/scene_keys.h"

namespace palp {

/// Controls that are shown together, in the order in which they are shown: keys of the table that have a KeyControl.
struct SceneControls {
    std::vector<const SceneKey*> sliders;
    std::vector<const SceneKey*> lists;
    bool                         edges = false; ///< the edges of the patch window belong here
};

/// Returns all controls of values that may change during a touch, except for the law of stiffness, which is a text,
/// and the edges, which are four names.
[[nodiscard]] std::span<const SceneControls> sceneControls();

/// Returns the values that a list offers; optionNow() returns the one that the scene has now.
[[nodiscard]] std::vector<std::string> optionsOf(const SceneKey& key);
[[nodiscard]] std::string              optionNow(const SceneKey& key, const Scene& scene);

/// Returns a number in the unit of its slider as a wish or a flag writes it: "4 mm".
[[nodiscard]] std::string wishText(const SceneKey& key, double shown);

/// Returns a stiffness that is felt beside the softest of a cloud: its largest, or ten times the softest where all are
/// nearly the same [the cloud's own kind].
[[nodiscard]] double contrastIn(const PointCloud& cloud);

/// Returns a law of stiffness to start from, from the least to the largest modulus of the cloud.
/// \param law  constant, linear, hyperbolic or gaussian
[[nodiscard]] std::string lawPreset(std::string_view law, const Scene& scene, const PointCloud& cloud);

} // namespace palp
