#pragma once
#include <vector>

#include "engine/cloud/neighbour_index.h"

namespace palp {

/// Returns the mean distance between the points of the surface around each point [m], for clouds whose density varies.
///
/// It takes d6 sqrt(pi/6) first, d6 the distance to the sixth neighbour: of n points per square metre, six lie in a
/// circle of area 6/n. Then it takes the median of that over the points within three times as far, so that one hole,
/// one stray or one pair of points does not count. A second sheet two spacings away does not disturb d6. Beside a step
/// in density, where most of these points are those of the dense side, it takes the median of the area. Strays take the
/// spacing of the others: they are few, or scatter every way, and do not go on as a surface does.
///
/// \return  one for each point that the index was built from, > 0
/// \throws Error if the cloud has fewer than seven points or most of them coincide
/// \thread pure; uses all cores, allocates
[[nodiscard]] std::vector<double> localSpacings(const NeighbourIndex& index);

/// Returns the same by the ranks of the points.
[[nodiscard]] std::vector<double> localSpacingsByRank(const NeighbourIndex& index);

} // namespace palp
