#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"

namespace palp {

/// What the neighbours of each point say about the surface there, measured once when an object is made.
///
/// Spacing: see localSpacings(). Where the points lie along lines (scan lines, the contours of a stack of slices), it
/// is that of the lines: the ball about the point grows until its points span a plane. A stray has that of the
/// others.
/// Normal: of the principal axes of the points within three spacings, (1 - d^2/r^2)^2 weighted. Its sign counts where
/// the point is `sided`: by a given normal, or because another layer of the object is closer behind it than some
/// spacings. Elsewhere whoever needs the sign carries it along the surface, as SurfaceFlood does.
/// Noise: the standard deviation of the points about a local quadric. Where it exceeds a tenth of a spacing the ball
/// grows until the deviation grows no more: noise has one size, shape grows with the ball. What grows for ever is
/// shape, and counts as clean. The median over the neighbours settles it. Of a thin body it is that of one face: points
/// of opposite given normals do not count, and where the deviations in a ball fall into two heaps, the point's own heap
/// does; noisy faces then have a side as well.
/// \thread immutable, so free to share
class SurfaceSurvey {
public:
    /// Takes about 1 s of one core for a million points, on all cores.
    /// \param given  [1] a normal for each point, 0 where there is none; empty: none at all
    explicit SurfaceSurvey(const NeighbourIndex& index, std::span<const glm::vec3> given = {});

    /// \throws Error if the cloud has fewer than seven points or most of them coincide: there is nothing to touch
    void expectSurface() const;

    [[nodiscard]] std::span<const double> spacings() const noexcept { return byPoint_; } ///< [m]; empty: no surface
    [[nodiscard]] double     spacing(std::size_t point) const noexcept { return byPoint_[point]; } ///< around it [m]
    [[nodiscard]] glm::dvec3 normal(std::size_t point) const noexcept
    {
        return normals_[ranks_[point]];
    }                                                                                               ///< unit, or 0 [1]
    [[nodiscard]] double noise(std::size_t point) const noexcept { return noises_[ranks_[point]]; } ///< [m]
    [[nodiscard]] bool   sided(std::size_t point) const noexcept { return sided_[ranks_[point]] != 0; } ///< see above
    /// Returns whether the side is that of a given normal.
    [[nodiscard]] bool given(std::size_t point) const noexcept { return sided_[ranks_[point]] == kGiven; }

    /// Returns whether two points are known to lie on opposite sides of the object.
    [[nodiscard]] bool apart(std::size_t one, std::size_t other) const noexcept
    {
        return sided(one) && sided(other) && glm::dot(normal(one), normal(other)) < 0;
    }

    // The same along the curve of the index: a touch asks about hundreds of thousands of points, and neighbours then
    // lie side by side in memory.

    [[nodiscard]] double     spacingOfRank(std::size_t rank) const noexcept { return spacings_[rank]; } ///< [m]
    [[nodiscard]] glm::dvec3 normalOfRank(std::size_t rank) const noexcept
    {
        return normals_[rank];
    }                                                                                           ///< unit, or 0 [1]
    [[nodiscard]] double noiseOfRank(std::size_t rank) const noexcept { return noises_[rank]; } ///< [m]
    [[nodiscard]] bool   sidedOfRank(std::size_t rank) const noexcept { return sided_[rank] != 0; }

private:
    class Measuring;

    void takeSides(std::span<const glm::vec3> given);

    static constexpr std::uint8_t kGiven = 2; ///< in sided_; 1: by layers

    std::vector<std::uint32_t> ranks_;   ///< of each point along the curve
    std::vector<double>        byPoint_; ///< spacing of each point [m]

    // By rank:
    std::vector<double>       spacings_; ///< [m]
    std::vector<glm::vec3>    normals_;  ///< [1]
    std::vector<float>        noises_;   ///< [m]
    std::vector<std::uint8_t> sided_;
};

} // namespace palp
