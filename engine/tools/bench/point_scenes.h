#pragma once
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/grid.h"

namespace palp::bench {

/// Makes nearly uniform points on a ball of 0.1 m with bumps, in Morton order [m].
[[nodiscard]] std::vector<glm::dvec3> bumpyBall(std::size_t points);

/// Returns places to search around: points of the cloud, moved by less than their mean distance `spacing` [m].
[[nodiscard]] std::vector<glm::dvec3> searchPlaces(const std::vector<glm::dvec3>& cloud, double spacing,
                                                   std::size_t count);

/// A grid of 1 mm and scattered points over a disc that holds it, as a gather radius does, in Morton order, as a radius
/// search over a cloud delivers them.
struct GridMapScene {
    PlateGrid               grid;
    ChartPoint              origin; ///< of node (0, 0) [m]
    std::vector<ChartPoint> points; ///< [m]

    GridMapScene(int nodes, double pointsPerCell);
};

} // namespace palp::bench
