#pragma once
#include <glm/vec3.hpp>

#include "engine/contact/detail/near_points.h"
#include "engine/contact/detail/surfaces.h"

namespace palp {

/// The end of a way through free space.
struct Arrival {
    glm::dvec3 position{};      ///< [m]
    bool       touched = false; ///< a surface lies between here and the goal; `position` is within one step of it
    bool       arrived = false; ///< at the goal
    double     support = 0;     ///< [1] of the surface touched
};

/// Carries a proxy from place to place without passing through the surface, however long the way.
///
/// Between points a ball is moved to its first touch with one, exactly, so that nothing is jumped over. Where points
/// are in the ball, known surfaces are followed in short steps until the proxy is behind one of them.
/// \thread one; allocates nothing after construction
class FreeTravel {
public:
    FreeTravel(NearPoints& points, SurfaceTracker& tracker) : points_(points), tracker_(tracker) {}

    /// Travels from `from` [m] to `to` [m], or to the first surface on the way.
    /// \param surfaces  known ones near `from`; on return those near the end
    [[nodiscard]] Arrival go(const glm::dvec3& from, const glm::dvec3& to, Surfaces& surfaces) noexcept;

private:
    [[nodiscard]] glm::dvec3 roll(const glm::dvec3& from, const glm::dvec3& to) noexcept;

    NearPoints&     points_;
    SurfaceTracker& tracker_;
};

} // namespace palp
