#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <glm/vec3.hpp>

#include "engine/chart/sphere_fit.h"
#include "engine/core/enum_names.h"
#include "engine/core/grid.h"

namespace palp {

/// The equal-area maps between the sphere and the plane of the plate.
enum class Map {
    gallPeters,         ///< x = r alpha/sqrt2, z = sqrt2 r sin beta: the paper's; stretched by sqrt2 at the contact
    lambertCylindrical, ///< x = r alpha, z = r sin beta: undistorted at the contact and along its parallel
    lambertAzimuthal    ///< equal-area about the contact: undistorted there and isotropic around it
};
constexpr auto namesOf(Map)
{
    using enum Map;
    return std::to_array<NamedValue<Map>>({{lambertAzimuthal, "lambert-azimuthal"},
                                           {lambertCylindrical, "lambert-cylindrical"},
                                           {gallPeters, "gall-peters"}});
}

/// Right-handed axes at the contact: east x north = normal.
struct Frame {
    glm::dvec3 normal{0, 0, 1}; ///< [1] outward, towards the hand
    glm::dvec3 east{1, 0, 0};   ///< [1] direction of chart x
    glm::dvec3 north{0, 1, 0};  ///< [1] direction of chart z

    /// Returns the world's axes carried from its z to a unit normal. Continuous except at the world's -z.
    [[nodiscard]] static Frame about(const glm::dvec3& normal);
    /// Returns this frame carried to another unit normal without twisting (parallel transport along the shortest arc).
    /// To the opposite normal, where every arc is shortest, it turns by the half turn about east.
    [[nodiscard]] Frame carriedTo(const glm::dvec3& newNormal) const;
    /// Returns this frame turned about its normal.
    /// \param angle  [rad]
    [[nodiscard]] Frame turned(double angle) const;
};

/// An equal-area map of the near hemisphere of a sphere onto a plane, centred at the contact.
///
/// All formulas are written in the signed curvature (positive where the surface bulges towards the normal, negative
/// in a bowl), so that the plane is an ordinary case and no digits are lost for large radii. With longitude alpha
/// (towards east) and latitude beta (towards north) about the contact, the direction from the centre is
/// cos beta cos alpha normal + cos beta sin alpha east + sin beta north.
/// \thread  pure value
/// \source  Kumari & Chaudhuri, eq. 4 (gall-peters); Snyder 1987, "Map Projections: A Working Manual" (the others)
/// \differs the paper's map stretches z by sqrt2 and shrinks x by sqrt2 right at the contact, so that an isotropic
///          plate answers a round load with a dip twice as long as wide; it is kept, but not the default
struct Chart {
    Map        map = Map::lambertAzimuthal;
    glm::dvec3 origin{}; ///< [m] foot of the contact on the fitted surface
    Frame      frame;
    double     curvature = 0; ///< [1/m] signed, see above

    /// Returns the chart about the foot of `contact` on the fitted surface.
    /// \param outward  roughly towards the hand; chooses the side of the surface (any non-zero vector)
    /// \param frame    axes to carry over from the neighbouring contact; empty: Frame::about
    [[nodiscard]] static Chart around(const SphereFit& fit, const glm::dvec3& contact, const glm::dvec3& outward,
                                      Map map, const std::optional<Frame>& frame = {});

    /// Returns the chart position of the radial projection of a point; empty beyond the hemisphere around the contact.
    [[nodiscard]] std::optional<ChartPoint> project(const glm::dvec3& point) const;
    /// Does the same for many points, to the bit, in a fraction of the time.
    /// \param positions  one for each point; anything where it has none
    /// \param on         1 for each point that has a position, else 0
    void project(std::span<const glm::dvec3> points, std::span<ChartPoint> positions, std::span<std::uint8_t> on) const;
    /// Returns the point of the sphere at a chart position [m]; empty outside the image of the hemisphere.
    [[nodiscard]] std::optional<glm::dvec3> lift(const ChartPoint& position) const;
};

} // namespace palp
