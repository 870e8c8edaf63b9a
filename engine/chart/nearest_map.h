#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/chart/chart.h"
#include "engine/core/grid.h"

namespace palp {

/// Finds for every node of a grid the number of the nearest point, in the order in which a NodeField stores nodes.
///
/// The answer is exact: the squared distances are compared in doubles, and of equally near points the lowest number
/// wins. The search is fastest with half to four points per cell of the grid; nodes far from every point cost more.
///
/// \param origin  position of node (0, 0) [m]
/// \param points  at least one, finite [m]; may lie outside the grid
/// \param exact   [m] nodes from which every point is farther get one that is near, not always the nearest, in a
///                fraction of the time
/// \thread        pure
[[nodiscard]] std::vector<std::uint32_t> nearestPoint(const PlateGrid& grid, const ChartPoint& origin,
                                                      std::span<const ChartPoint> points,
                                                      double exact = std::numeric_limits<double>::infinity());

} // namespace palp
