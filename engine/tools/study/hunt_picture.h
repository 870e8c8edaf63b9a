#pragma once
#include <string>

#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud.h"
#include "engine/tools/study/hunt_score.h"

namespace palp::study {

/// The object from the hand's side with what was hidden, found and missed, the places that were declared and the way of
/// the contact: a self-contained SVG picture, told apart by shapes and dashes as well as by colours. Lengths in metres.
/// \param place    in the middle [m]  \param outward  towards the eye [1]
/// \param ground   radius that is shown [m]; 0: all of the object
[[nodiscard]] std::string huntSvg(const HuntScore& score, const PointCloud& cloud, const glm::dvec3& place,
                                  const glm::dvec3& outward, double ground);

} // namespace palp::study
