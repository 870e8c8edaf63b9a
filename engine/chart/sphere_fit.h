#pragma once
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

namespace palp {

/// A sphere or its limit, a plane, as the zero set of
///     f(p) = (curvature/2) |q|^2 + gradient . q + offset,   q = p - reference,
/// scaled so that |gradient|^2 - 2 curvature offset = 1 (Pratt's normalisation: |grad f| = 1 on the surface).
/// Nothing here blows up when curvature goes to 0. f < 0 lies inside a sphere of positive curvature.
struct SphereFit {
    glm::dvec3 reference{};       ///< [m] centroid of the fitted points
    double     curvature = 0;     ///< [1/m] 1/radius, >= 0; 0 is a plane
    glm::dvec3 gradient{0, 0, 1}; ///< [1] of f at the reference
    double     offset = 0;        ///< [m] f at the reference
    double     misfit = 0;        ///< [m] root mean square distance of the fitted points from the surface

    [[nodiscard]] double     radius() const noexcept;                                ///< [m] infinity for a plane
    [[nodiscard]] glm::dvec3 centre() const noexcept;                                ///< [m] not finite for a plane
    [[nodiscard]] double     signedDistance(const glm::dvec3& point) const noexcept; ///< [m] > 0 outside
    [[nodiscard]] glm::dvec3 normal(const glm::dvec3& point) const noexcept;         ///< [1] away from the centre
    [[nodiscard]] glm::dvec3 foot(const glm::dvec3& point) const noexcept;           ///< [m] nearest surface point
};

/// What a set of points determines.
enum class FitOutcome {
    sphere,
    plane,        ///< curvature is zero within rounding; the fit holds the least-squares plane
    tooFewPoints, ///< fewer than four distinct points
    ring,         ///< the points lie on one circle: infinitely many spheres pass through it
    line          ///< the points lie on one line (or coincide): not even a plane is determined
};

/// "sphere", "plane", ... for reports.
[[nodiscard]] const char* name(FitOutcome outcome) noexcept;

struct SphereFitResult {
    FitOutcome outcome = FitOutcome::tooFewPoints;
    SphereFit  fit;

    [[nodiscard]] bool usable() const noexcept { return outcome == FitOutcome::sphere || outcome == FitOutcome::plane; }
};

[[nodiscard]] SphereFitResult fitSphere(std::span<const glm::dvec3> points);

} // namespace palp
