#pragma once
#include <string>

#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud.h"
#include "engine/tools/study/hunt_score.h"

namespace palp::study {

/// Draws the object from the hand's side with the nodules found and missed, the declared places and the path of the
/// contact: a self-contained SVG picture with shapes and dashes as well as colours. Lengths are in metres.
/// \param place    shown in the middle [m]
/// \param outward  unit vector towards the viewer [1]
/// \param ground   radius that is shown [m]; 0: all of the object
[[nodiscard]] std::string huntSvg(const HuntScore& score, const PointCloud& cloud, const glm::dvec3& place,
                                  const glm::dvec3& outward, double ground);

} // namespace palp::study
