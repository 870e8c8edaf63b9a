#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"

namespace palp {

/// The surface of a cloud's points: a normal and a disc for each, from its neighbours at rest.
class CloudSkin {
public:
    /// \param positions  at rest, those that the index was built from [m]
    /// \throws Error if the cloud has fewer than seven points or most of them coincide
    CloudSkin(std::span<const glm::dvec3> positions, const NeighbourIndex& index);

    /// Returns the radii of discs whose means make a smooth surface [m].
    [[nodiscard]] std::span<const double> radii() const noexcept { return radii_; }

    /// Returns the radii of their cores, at most radii(), which alone close the surface and end where the points end: a
    /// core reaches the places that are farther from all other points [m].
    [[nodiscard]] std::span<const double> cores() const noexcept { return cores_; }

    /// Returns the normals of the points at their present places, of either side [1]: those of least squares planes
    /// through each point and the neighbours it had at rest.
    /// \param positions  of all points [m]
    [[nodiscard]] std::vector<glm::dvec3> normals(std::span<const glm::dvec3> positions) const;

    /// Turns the normals of one side to one side, and those of closed pieces of the surface outwards.
    /// \param positions, normals  of all points at rest [m], [1]
    /// \return for each point 1 if it belongs to a closed piece, of which only the outside can be seen; else 0
    [[nodiscard]] std::vector<std::uint8_t> turnOutwards(std::span<const glm::dvec3> positions,
                                                         std::span<glm::dvec3>       normals) const;

    /// Returns the values of all points, each the mean over the point's neighbours.
    [[nodiscard]] std::vector<double> smoothed(std::span<const double> values) const;

    /// Updates the normals of a few points whose neighbourhood moved, and keeps their sides; the others' stay.
    void refit(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> points,
               std::span<glm::dvec3> normals) const;

private:
    /// Radius of a disc over the spacing, whose square is a point's area: smaller ones leave stains where points are
    /// strewn at random, larger ones take longer [1].
    static constexpr double kDisc = 2.1;

    [[nodiscard]] glm::dvec3 normalOf(std::span<const glm::dvec3> positions, std::size_t point) const;
    [[nodiscard]] double     coreOf(std::span<const glm::dvec3> positions, std::size_t point, double spacing) const;

    std::size_t                each_ = 0;      // neighbours of a point, itself included
    std::vector<std::uint32_t> neighbours_;    // point by point
    std::vector<double>        radii_, cores_; // [m]
};

} // namespace palp
