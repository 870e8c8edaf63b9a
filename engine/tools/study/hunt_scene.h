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
    std::optional<std::uint64_t> seed; ///< places the nodules anew; empty: where the hunt has them

    [[nodiscard]] PointCloud over(const PointCloud& cloud, const Scene& scene) const override;

    /// Where they lie in this cloud. \throws Error as hiddenNodules() does
    [[nodiscard]] std::vector<Nodule> nodules(const PointCloud& cloud, const Scene& scene) const;
};

/// The keys "hunt" and "hunt_seed", for SceneOverrides::toolKeys.
[[nodiscard]] const std::vector<SceneKey>& huntKeys();

/// What is hidden in a scene that was read with huntKeys(); null for nothing.
[[nodiscard]] const HiddenNodules* hiddenIn(const Scene& scene);

} // namespace palp::study
