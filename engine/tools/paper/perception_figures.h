#pragma once
#include <string>

#include "engine/tools/paper/felt_map.h"
#include "engine/tools/paper/scene_perception.h"

namespace palp::report {

/// Felt stiffness along the path: at rest, sliding, and sliding over the homogeneous object.
[[nodiscard]] std::string pathSvg(const ScenePerception& perception, ForceLaw law, const std::string& title);

/// The object in the colours of how surely a place is told from the typical one.
/// \param weber    [1]
/// \param outward  the side to look from [1]
[[nodiscard]] std::string mapSvg(const PointCloud& cloud, const FeltMap& map, double weber, const glm::dvec3& outward,
                                 const std::string& title);

} // namespace palp::report
