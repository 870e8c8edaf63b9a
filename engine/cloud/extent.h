#pragma once
#include <span>

#include <glm/vec3.hpp>

namespace palp {

/// How far an object reaches. It does not change as the object is turned.
struct Extent {
    double across = 0; ///< largest distance of two of its points [m]
    double length = 0; ///< of a strip, or of a square from corner to corner, that spreads as far about its middle; at
                       ///< most sqrt 2 times `across` [m]
};

/// Finds the largest distance by going to the farthest point from the last such point, some times: of all but odd
/// shapes that finds it, and never less than 0.57 of it.
/// \param spacings  [m] by point: each point spreads by the area that it stands for; empty: all alike
[[nodiscard]] Extent extentOf(std::span<const glm::dvec3> points, std::span<const double> spacings);

} // namespace palp
