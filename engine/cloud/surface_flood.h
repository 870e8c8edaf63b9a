#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/point_grid.h"
#include "engine/cloud/soft_object.h"

namespace palp {

/// Finds the piece of surface in a ball that hangs together with the ball's middle, so that what happens to one side of
/// a thin object does not happen to the other.
///
/// From the point nearest to the middle a flood goes from point to point, inside the ball, over steps of at most
/// kLongestStep local spacings that run along the sheet (SurfaceLinks). The normals' sign is carried along, as
/// most of the neighbours that were reached before ask for. Points
/// whose side the survey knows must all face alike: so layers half a spacing apart are told apart. Around a rim that is
/// inside the ball the flood does reach the other side, whose normals then point away. Beside a tenfold step in density
/// it passes over one point in some thousand that has no neighbour as near as its spacing tells.
/// \thread one; allocates only where it has not had as many points before, or where nobody has flooded before
class SurfaceFlood {
public:
    /// \param object  outlives this
    /// \throws Error if the cloud has fewer than seven points or most of them coincide
    explicit SurfaceFlood(const SoftObject& object);

    /// Finds the points of the piece, in the order in which the flood came to them; empty if no point is in the ball.
    /// Valid until the next call.
    /// \param centre   [m], finite
    /// \param radius   [m], >= 0
    /// \param outward  roughly away from the side that is wanted, any length; empty: the side of the nearest point
    [[nodiscard]] std::span<const std::uint32_t> reach(const glm::dvec3& centre, double radius,
                                                       const std::optional<glm::dvec3>& outward = {});

    /// Does the same for a ball whose points are known, and returns their numbers among them. Valid until the next
    /// call.
    /// \param ranks    of points of the object along its index, in any order; rising ones take least time
    /// \param sparser  their spacing over the object's, where they are a share of its points [1]
    [[nodiscard]] std::span<const std::uint32_t> reachIn(std::span<const std::uint32_t> ranks, const glm::dvec3& centre,
                                                         const std::optional<glm::dvec3>& outward = {},
                                                         double                           sparser = 1);

    /// Returns the normals of the points that the last call found, in the same order, their signs carried from the
    /// first one, whose normal points along `outward` [1]. A point without a normal has that of the point before it.
    [[nodiscard]] std::span<const glm::dvec3> normals() const noexcept { return normals_; }

private:
    [[nodiscard]] std::optional<std::size_t> start(const glm::dvec3& centre, const std::optional<glm::dvec3>& outward);
    [[nodiscard]] bool                       isNear(std::size_t from, std::size_t to, double distance2) const noexcept;
    [[nodiscard]] bool                       runsAlong(std::size_t from, std::size_t to) const noexcept;
    [[nodiscard]] bool                       take(std::size_t from, std::size_t to);
    void                                     noteSide(std::size_t reached);
    void                                     floodByLinks();
    void                                     floodByGrid(double longest);

    const SoftObject& object_;

    // Scratch: the points of the ball, and what the flood has reached and not yet left, as indices among them.
    std::span<const std::uint32_t> ranks_;
    std::vector<std::uint32_t>     gathered_;
    std::vector<glm::dvec3>        places_;  ///< [m]
    std::vector<double>            steps_;   ///< longest of each [m]
    std::vector<glm::dvec3>        carried_; ///< normals as carried, of those that are reached [1]
    std::vector<std::uint32_t>     reached_;
    std::vector<std::uint32_t>     found_, points_; ///< ranks; points of the object
    std::vector<glm::dvec3>        normals_;        ///< [1]
    PointGrid                      grid_;
    std::optional<bool>            inverted_; ///< the carried normals point inwards; empty: no side is known yet
};

} // namespace palp
