#pragma once
#include <string>

#include "engine/perception/felt_map.h"
#include "engine/perception/scene_perception.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp::report {

/// Plots felt stiffness along the path: at rest, sliding, and sliding over the homogeneous object.
[[nodiscard]] std::string pathSvg(const ScenePerception& perception, ForceLaw law, const std::string& title);

/// Draws the object, coloured by how surely a place is distinguished from the typical one.
/// \param weber    smallest relative change that is noticed [1]
/// \param outward  unit vector towards the viewer [1]
[[nodiscard]] std::string mapSvg(const PointCloud& cloud, const FeltMap& map, double weber, const glm::dvec3& outward,
                                 const std::string& title, FigureRenderer& renderer);

} // namespace palp::report
