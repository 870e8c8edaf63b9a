#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/contact/detail/near_points.h"

namespace palp {

/// The tangent plane of a piece of the surface, on the side from which it is touched.
struct SurfacePlane {
    glm::dvec3 normal{0, 0, 1}; ///< [1] unit, towards the hand
    glm::dvec3 foot{};          ///< [m] a point of the surface
    double     support = 0;     ///< [1] 1: points all around; 0: at or beyond a border
    int        side    = 0;     ///< 1: of points that face along the normal; -1: against it; 0: of any points

    /// Returns the height of a place over the plane [m], negative behind it.
    [[nodiscard]] double height(const glm::dvec3& place) const noexcept;
};

/// The result of a fit.
struct PlaneFit {
    SurfacePlane plane;
    double       spacing = 0; ///< [m] weighted mean of the points' own
    double       raised  = 0; ///< [m] how far the surface was from the place of the fit, along the new normal
};

/// Fits the surface through the points about a place that lie near a given plane, by weighted least squares.
///
/// In tangent coordinates (a, b) and height h over the given plane, with q = a^2 + b^2 and d^2 = q + h^2:
///
///     h ~ alpha + beta a + gamma b + K q,    weights (1 - d^2/r^2)^2 psi(|h|)
///
/// psi falls from 1 to 0 between two heights, so that a second sheet does not count. With s the spacing, K is shrunk to
/// K (K s)^2 / ((K s)^2 + k0^2) and clamped, and the rest is solved again: curvature that noise could have made counts
/// as none; smoothed points have little noise, and k0 is smaller there. The new normal is that of the given plane,
/// tilted by (beta, gamma): its side cannot flip. The radius r grows in holes. Support falls where the centroid of the
/// points is off centre, as at a border.
///
/// \thread one; allocates nothing after construction
/// \source our own reconstruction; constants chosen by our own prototype on 8 to 40 random clouds a case
class PlaneFitter {
public:
    explicit PlaneFitter(NearPoints& points);

    /// Fits the surface at a place.
    /// \param place    [m] near the surface
    /// \param normal   [1] unit; the plane through `place` that the surface is near to
    /// \param spacing  [m] around here
    /// \param others   a point nearer to one of these than to the given plane is omitted
    /// \param side     of the surface, see SurfacePlane: points known to face the other way are omitted
    /// \return         empty if fewer than six points are near
    [[nodiscard]] std::optional<PlaneFit> fit(const glm::dvec3& place, const glm::dvec3& normal, double spacing,
                                              std::span<const SurfacePlane> others, int side = 0) noexcept;

private:
    /// A point near the plane, as seen from the place.
    struct Seen {
        double a = 0, b = 0, h = 0; ///< [m]
        double d2      = 0;         ///< [m^2]
        double spacing = 0;         ///< [m]
        bool   own     = true;      ///< of this surface, not of another known one
        double smooth  = 0;         ///< [1] 1: of a smoothed point
    };
    struct Frame {
        glm::dvec3                    place, normal, u, v;
        double                        spacing;
        std::span<const SurfacePlane> others;
        int                           side;
    };

    void                 collect(const Frame& frame, double radius);
    [[nodiscard]] double collectEnough(const Frame& frame);

    NearPoints&         points_;
    std::vector<Seen>   seen_;
    std::size_t         owned_ = 0; ///< number of own points
    std::vector<double> squares_;   ///< [m^2] scratch of collectEnough
};

/// Surfaces whose normals have a larger cosine are one surface [1]: 32 degrees.
inline constexpr double kSameSurface = 0.848;

/// A point counts fully up to the first height, and not at all from the second on [spacings]: noise of 0.2 spacings
/// passes, a sheet two spacings below does not.
inline constexpr double kFullHeight = 0.8;
inline constexpr double kNoHeight   = 1.4;

/// Longest single step [spacings]: less than kFullHeight, so that one step cannot leave the heights that count.
inline constexpr double kStepCap = 0.5;

} // namespace palp
