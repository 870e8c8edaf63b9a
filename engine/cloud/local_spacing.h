#pragma once
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"

namespace palp {

/// Returns the mean distance between the points of the surface around each point [m], for clouds whose density varies.
///
/// It takes d6 sqrt(pi/6) first, d6 the distance to the sixth neighbour: of n points per square metre, six lie in a
/// circle of area 6/n. Then it takes the median of that over the points within three times as far, so that one hole,
/// one stray or one pair of points does not count. A second sheet two spacings away does not disturb d6. Beside a step
/// in density, where most of these points are those of the dense side, it takes the median of the area.
///
/// \param positions  those that the index was built from
/// \return           as many as positions, each > 0
/// \throws Error if the cloud has fewer than seven points or most of them coincide
/// \thread pure; allocates
[[nodiscard]] std::vector<double> localSpacings(std::span<const glm::dvec3> positions, const NeighbourIndex& index);

} // namespace palp
