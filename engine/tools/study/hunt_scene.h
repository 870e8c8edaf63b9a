#pragma once
#include <optional>
#include <vector>

#include "engine/session/scene_keys.h"
#include "engine/tools/study/hunt.h"

namespace palp::study {

/// The hunt of a scene. It lies over the scene's cloud, so that every command feels the nodules.
class HiddenNodules : public CloudOverlay {
public:
    Hunt                         hunt;
    std::optional<std::uint64_t> seed; ///< places the nodules at random; empty: at the hunt's own places

    [[nodiscard]] PointCloud                over(const PointCloud& cloud, const Scene& scene) const override;
    [[nodiscard]] std::vector<BuriedNodule> below(const PointCloud& cloud, const Scene& scene) const override;

    /// Returns the nodules at their places in this cloud.
    /// \throws Error as hiddenNodules() does
    [[nodiscard]] std::vector<Nodule> nodules(const PointCloud& cloud, const Scene& scene) const;
};

/// Returns the keys "hunt" and "hunt_seed", for SceneOverrides::toolKeys.
[[nodiscard]] const std::vector<SceneKey>& huntKeys();

/// Returns the nodules that are hidden in a scene that was read with huntKeys(); null if there are none.
[[nodiscard]] const HiddenNodules* hiddenIn(const Scene& scene);

} // namespace palp::study
