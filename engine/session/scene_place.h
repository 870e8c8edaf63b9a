#pragma once
#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud.h"
#include "engine/session/scene.h"

namespace palp {

/// Returns Scene::place, or the point of the cloud nearest to a viewer who looks along -z: the highest, and of
/// a flat top, nine tenths as wide as the cloud both ways at least, the one in the middle. Strays in the air do not
/// count.
/// \return [m]
/// \thread pure; allocates
[[nodiscard]] glm::dvec3 placeOf(const Scene& scene, const PointCloud& cloud);

} // namespace palp
