#pragma once
#include "engine/tools/bench/outside_peers.h"

namespace palp::bench {

/// Makes a tree of nanoflann in floats with unsorted answers, which is its fastest form.
/// \param leaf  largest number of points in a leaf
[[nodiscard]] std::unique_ptr<RadiusSearch> nanoflannSearch(std::span<const glm::dvec3> points, std::size_t leaf);

/// Finds the nearest point of every node; building the tree is part of the work.
[[nodiscard]] std::vector<std::uint32_t> nanoflannMap(const PlateGrid& grid, const ChartPoint& origin,
                                                      std::span<const ChartPoint> points, std::size_t leaf);

} // namespace palp::bench
