#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/cloud/point_grid.h"

namespace palp {

/// Finds the piece of surface in a ball that hangs together with the ball's middle, so that a change to one side of a
/// thin object is not made to the other.
///
/// From the point nearest to the middle a flood goes from point to point, inside the ball, over steps of at most
/// kStep local spacings. Sides three spacings apart are told apart; closer ones may run together. Around a rim that is
/// inside the ball the flood does reach the other side. Beside a tenfold step in density it passes over one point in
/// some thousand that has no neighbour as near as its spacing tells.
/// \thread one; allocates only where it has not had as many points before
class SurfaceFlood {
public:
    /// Longest step in spacings of the sparser of its two points [1]. A disc of that radius holds 13 random points, so
    /// that one in 300 000 has no neighbour; the two sides of an object must be further apart.
    static constexpr double kStep = 2;

    /// Measures the local spacing around every point: 3 s for a million.
    /// \param positions  [m] those that the index was built from; both must outlive this
    /// \throws Error if the cloud has fewer than seven points or most of them coincide
    SurfaceFlood(std::span<const glm::dvec3> positions, const NeighbourIndex& index);

    /// Finds the points of the piece, in no order; empty if no point is in the ball. Valid until the next call.
    /// \param centre  [m], finite
    /// \param radius  [m], >= 0
    [[nodiscard]] std::span<const std::uint32_t> reach(const glm::dvec3& centre, double radius);

    [[nodiscard]] double spacing(std::size_t point) const noexcept { return spacings_[point]; } ///< around it [m]

private:
    std::span<const glm::dvec3> positions_; ///< [m]
    const NeighbourIndex&       index_;
    std::vector<double>         spacings_; ///< [m]

    // Scratch: the points of the ball, and what the flood has reached and not yet left, as indices among them.
    std::vector<std::uint32_t> inBall_;
    std::vector<glm::dvec3>    places_; ///< [m]
    std::vector<double>        steps_;  ///< longest of each [m]
    std::vector<std::uint32_t> reached_;
    std::vector<std::uint32_t> points_;
    PointGrid                  grid_;
};

} // namespace palp
