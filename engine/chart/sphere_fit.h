#pragma once
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "engine/core/enum_names.h"

namespace palp {

/// A sphere or its limit, a plane, as the zero set of
///     f(p) = (curvature/2) |q|^2 + gradient . q + offset,   q = p - reference,
/// scaled so that |gradient|^2 - 2 curvature offset = 1 (Pratt's normalisation: |grad f| = 1 on the surface).
/// Nothing here diverges when curvature goes to 0. f < 0 lies inside a sphere of positive curvature.
struct SphereFit {
    glm::dvec3 reference{};       ///< [m] centroid of the fitted points, or the anchor of the fit
    double     curvature = 0;     ///< [1/m] 1/radius, >= 0; 0 is a plane
    glm::dvec3 gradient{0, 0, 1}; ///< [1] of f at the reference
    double     offset = 0;        ///< [m] f at the reference
    double     misfit = 0;        ///< [m] (weighted) root mean square distance of the fitted points from the surface

    [[nodiscard]] double     radius() const noexcept;                                ///< [m] infinity for a plane
    [[nodiscard]] glm::dvec3 centre() const noexcept;                                ///< [m] not finite for a plane
    [[nodiscard]] double     signedDistance(const glm::dvec3& point) const noexcept; ///< [m] > 0 outside
    /// Returns the unit direction away from the centre [1]; at the centre itself a fixed arbitrary one.
    [[nodiscard]] glm::dvec3 normal(const glm::dvec3& point) const noexcept;
    [[nodiscard]] glm::dvec3 foot(const glm::dvec3& point) const noexcept; ///< [m] nearest surface point
};

/// The kinds of surface that a set of points determines.
enum class FitOutcome {
    sphere,
    plane,        ///< curvature is zero within rounding; the fit holds the least-squares plane
    tooFewPoints, ///< fewer than four distinct points
    ring,         ///< the points lie on one circle: infinitely many spheres pass through it
    line          ///< the points lie on one line: not even a plane is determined
};
constexpr auto namesOf(FitOutcome)
{
    using enum FitOutcome;
    return std::to_array<NamedValue<FitOutcome>>(
        {{sphere, "sphere"}, {plane, "plane"}, {tooFewPoints, "too few points"}, {ring, "ring"}, {line, "line"}});
}

struct SphereFitResult {
    FitOutcome outcome = FitOutcome::tooFewPoints;
    SphereFit  fit; ///< meaningful if usable()

    [[nodiscard]] bool usable() const noexcept { return outcome == FitOutcome::sphere || outcome == FitOutcome::plane; }
};

/// Fits a sphere to points by Pratt's normalised algebraic distance.
///
/// With rows design_i = (|x_i|^2, x_i, 1) it minimises |design u|^2 subject to u1^2 + u2^2 + u3^2 - 4 u0 u4 = 1 for
/// u0 |x|^2 + (u1,u2,u3) . x + u4 = 0: the eigenvector of  (design^T design) u = eta C u  with the smallest eta >= 0
/// and u^T C u > 0. Centre -(u1,u2,u3) / (2 u0), radius 1 / (2 |u0|); u0 -> 0 is a plane, not a failure.
/// The answer is the same for points moved, turned or scaled. Only rounding separates a plane from a sphere, and a
/// ring from a narrow band: noise on a plane gives a sphere of large radius, which callers need not tell apart.
///
/// \param points  positions [m], finite, any number and order, repeats allowed (each counts)
/// \return the kind of surface that the points determine, and the fit if it is a sphere or a plane
/// \throws ContractViolation naming the first point that is not finite
/// \thread pure; memory is constant, time linear in the number of points
/// \source Pratt 1987, "Direct least-squares fitting of algebraic surfaces"; Kumari & Chaudhuri, eqs 1-3
/// \differs         Eq. 3 divides by u4; with eq. 1 as written the divisor is u0.
///                  The points are centred and scaled to unit rms first: uncentred, single precision finds a radius
///                  of 37 for a cap of radius 5 some 27 away, and double loses half its digits.
///                  The paper runs the QZ algorithm on (design^T design, C). Here design = Q R, R = W S V^T, and with
///                  u = V S^-1 v the same problem reads  (S^-1 V^T C V S^-1) v = v / eta: symmetric, so eta is real,
///                  ordered, and positive exactly when u^T C u is; there is nothing to choose among eigenvalues that
///                  rounding makes +1e-17 or -1e-17, and no product design^T design that halves the digits when the
///                  points fill a narrow band. The tests run QZ beside it.
[[nodiscard]] SphereFitResult fitSphere(std::span<const glm::dvec3> points);

/// Fits a sphere through an anchor to weighted points by the same algebraic distance.
///
/// About the anchor u4 = 0. With x = p - anchor it minimises  sum w (u0 |x|^2 + u . x)^2  subject to |u| = 1, which is
/// Pratt's constraint there. Whatever u is, u0 = -b . u / a is best, with a = sum w |x|^4 and b = sum w |x|^2 x; so the
/// normal at the anchor, u, is the eigenvector of  sum w x x^T - b b^T / a  with the smallest eigenvalue. The surface
/// holds the anchor exactly, and only points that bear weight move it: with weights that fall to zero at a distance r
/// about a place on a smooth surface, normal and mean curvature there are right up to terms in r^2.
/// The answer is the same for points moved, turned or scaled, and for weights scaled.
///
/// \param anchor   [m], finite
/// \param points   positions [m], finite, any number and order, repeats allowed (each counts)
/// \param weights  [1] one for each point, finite, >= 0; points without weight do not count
/// \return as fitSphere, where the anchor counts as a point; the reference is the anchor, the offset 0, and the misfit
///         the weighted root mean square distance
/// \throws ContractViolation naming the first point or weight that is not as above
/// \thread pure; memory is constant, time linear in the number of points
/// \source Pratt 1987, "Direct least-squares fitting of algebraic surfaces", with one point interpolated
/// \differs that matrix is never built. In design = Q R with the column |x|^2 first, the trailing 3x3 block R' of R has
///          R'^T R' = it, and u is the last right singular vector of R': no product or difference halves the digits.
[[nodiscard]] SphereFitResult fitSphereThrough(const glm::dvec3& anchor, std::span<const glm::dvec3> points,
                                               std::span<const double> weights);

} // namespace palp
