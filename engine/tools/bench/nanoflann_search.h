#pragma once
#include "engine/tools/bench/outside_peers.h"

namespace palp::bench {

/// nanoflann in floats, answers unsorted: its fastest way. \param leaf  most points of a leaf [1]
[[nodiscard]] std::unique_ptr<RadiusSearch> nanoflannSearch(std::span<const glm::dvec3> points, std::size_t leaf);

/// For every node the nearest point, tree included.
[[nodiscard]] std::vector<std::uint32_t> nanoflannMap(const PlateGrid& grid, const ChartPoint& origin,
                                                      std::span<const ChartPoint> points, std::size_t leaf);

} // namespace palp::bench
