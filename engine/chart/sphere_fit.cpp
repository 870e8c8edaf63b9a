#include "engine/chart/sphere_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Vector5 = Eigen::Matrix<double, 5, 1>;

// Order of the unknowns. Position is first, so that the leading 3x3 block of R is the factor of the positions alone.
enum Column { kX, kY, kZ, kSquare, kOne };

// Number of rounding units by which a row of the scaled design may be off, when the coordinates are right to half a
// unit: shift 1, scale 2, square and sum 5, factorisation about as much again. If it is smaller, exact planes far from
// the origin turn into spheres; if larger, true curvature is thrown away.
constexpr double kRowRounding = 16;

// The least uncertainty of the fit's unit-length coefficients [1], caused by rounding alone, that counts as "not
// determined": fewer than one digit. A ring has about 10; a band 1e-12 of its radius wide has 0.004.
constexpr double kUndetermined = 0.1;

double largestCoordinate(const glm::dvec3& p)
{
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

void expectFinite(std::span<const glm::dvec3> points)
{
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3& p = points[i];
        PALP_EXPECT(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
                    "point " + std::to_string(i) + " of " + std::to_string(points.size()) + " is (" +
                        std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")");
    }
}

bool hasFourDistinct(std::span<const glm::dvec3> points)
{
    std::array<glm::dvec3, 3> seen;
    std::size_t               count = 0;
    for (const glm::dvec3& p : points) {
        if (std::find(seen.begin(), seen.begin() + count, p) != seen.begin() + count) continue;
        if (count == seen.size()) return true;
        seen[count++] = p;
    }
    return false;
}

/// Position and size of the points: x = (p - centroid) / scale has mean 0 and root mean square 1.
struct Placement {
    glm::dvec3 centroid{};   ///< [m]
    double     scale    = 0; ///< [m]
    double     rounding = 0; ///< [1] of x: the coordinates' own rounding, as large as it is far from the origin

    explicit Placement(std::span<const glm::dvec3> points)
    {
        const glm::dvec3 first    = points.front();
        const double     count    = double(points.size());
        double           farthest = 0;
        for (const glm::dvec3& p : points) {
            centroid += (p - first) / count;
            farthest = std::max(farthest, largestCoordinate(p));
        }
        centroid += first;

        // Squares of tiny or huge distances leave the range of doubles; squares of ratios do not.
        double extent = 0;
        for (const glm::dvec3& p : points) extent = std::max(extent, largestCoordinate(p - centroid));
        double sum = 0;
        for (const glm::dvec3& p : points) sum += glm::dot((p - centroid) / extent, (p - centroid) / extent);
        scale    = extent * std::sqrt(sum / count);
        rounding = std::numeric_limits<double>::epsilon() * std::max(1.0, farthest / scale);
    }
};

/// Computes R of design = Q R, divided by the square root of the number of points so that it does not grow with it, by
/// Householder on a fixed block of rows below the R so far: constant memory. R stays triangular by itself, because a
/// reflection leaves alone the rows that are zero in its column.
Matrix5 factorOfDesign(std::span<const glm::dvec3> points, const Placement& placement)
{
    constexpr int kBlock = 64; // rows: long enough to hide the five rows carried along, short enough for the stack
    using Stack          = Eigen::Matrix<double, 5 + kBlock, 5>;
    Stack        stack   = Stack::Zero();
    const double weight  = 1 / std::sqrt(double(points.size()));
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
        const auto block = points.subspan(begin, std::min<std::size_t>(kBlock, points.size() - begin));
        stack.bottomRows<kBlock>().setZero();
        for (std::size_t i = 0; i < block.size(); ++i) {
            const glm::dvec3 x = (block[i] - placement.centroid) / placement.scale;
            stack.row(5 + int(i)) << weight * x.x, weight * x.y, weight * x.z, weight * glm::dot(x, x), weight;
        }
        Eigen::HouseholderQR<Eigen::Ref<Stack>> inPlace(stack);
    }
    return stack.topRows<5>();
}

/// Returns C of Pratt's constraint u^T C u = u1^2 + u2^2 + u3^2 - 4 u0 u4 = 1, in the order of Column.
Matrix5 prattConstraint()
{
    Matrix5 c        = Matrix5::Zero();
    c(kX, kX)        = 1;
    c(kY, kY)        = 1;
    c(kZ, kZ)        = 1;
    c(kSquare, kOne) = -2;
    c(kOne, kSquare) = -2;
    return c;
}

/// Returns the coefficients of the fit, scaled so that u^T C u = 1 (see fitSphere).
Vector5 prattVector(const Eigen::JacobiSVD<Matrix5>& svd)
{
    // Points exactly on a sphere have a last singular value of 0; raised to rounding it stays the smallest by far, and
    // the vector moves by less than rounding.
    const Vector5 singular = svd.singularValues();
    const Vector5 inverse  = singular.cwiseMax(singular[0] * std::numeric_limits<double>::epsilon()).cwiseInverse();
    const Matrix5 toDesign = svd.matrixV() * inverse.asDiagonal();

    // C has four positive eigenvalues and one negative, and congruence keeps their signs: the last one is positive.
    const Eigen::SelfAdjointEigenSolver<Matrix5> eigen(toDesign.transpose() * prattConstraint() * toDesign);
    const Vector5                                u = (toDesign * eigen.eigenvectors().col(4)).normalized();
    return u / std::sqrt(u.dot(prattConstraint() * u));
}

SphereFit planeThrough(const Placement& placement, const Eigen::Vector3d& normal)
{
    // The one of the two normals whose largest component is positive, so that the answer does not depend on rounding.
    Eigen::Index largest = 0;
    normal.cwiseAbs().maxCoeff(&largest);
    const Eigen::Vector3d n = normal * std::copysign(1.0, normal[largest]);

    SphereFit plane;
    plane.reference = placement.centroid;
    plane.gradient  = {n[0], n[1], n[2]};
    return plane;
}

SphereFit sphereFrom(const Placement& placement, const Vector5& u)
{
    const double sign = std::copysign(1.0, u[kSquare]);
    SphereFit    sphere;
    sphere.reference = placement.centroid;
    sphere.curvature = sign * 2 * u[kSquare] / placement.scale;
    sphere.gradient  = sign * glm::dvec3(u[kX], u[kY], u[kZ]);
    sphere.offset    = sign * u[kOne] * placement.scale;
    return sphere;
}

double rootMeanSquareDistance(const SphereFit& fit, std::span<const glm::dvec3> points)
{
    double sum = 0;
    for (const glm::dvec3& p : points) sum += fit.signedDistance(p) * fit.signedDistance(p);
    return std::sqrt(sum / double(points.size()));
}

} // namespace

double SphereFit::radius() const noexcept
{
    return 1 / curvature;
}

glm::dvec3 SphereFit::centre() const noexcept
{
    return reference - gradient / curvature;
}

double SphereFit::signedDistance(const glm::dvec3& point) const noexcept
{
    // At distance d from the centre of a sphere of radius r, f = (d^2 - r^2) / (2 r) and |grad f| = d / r, so
    // d - r = 2 f / (1 + |grad f|): no difference of large numbers, and simply f on a plane.
    const glm::dvec3 q = point - reference;
    const double     f = 0.5 * curvature * glm::dot(q, q) + glm::dot(gradient, q) + offset;
    return 2 * f / (1 + glm::length(gradient + curvature * q));
}

glm::dvec3 SphereFit::normal(const glm::dvec3& point) const noexcept
{
    const glm::dvec3 direction = gradient + curvature * (point - reference);
    const double     length    = glm::length(direction);
    return length > 0 ? direction / length : glm::dvec3(0, 0, 1);
}

glm::dvec3 SphereFit::foot(const glm::dvec3& point) const noexcept
{
    return point - signedDistance(point) * normal(point);
}

SphereFitResult fitSphere(std::span<const glm::dvec3> points)
{
    expectFinite(points);
    if (!hasFourDistinct(points)) return {FitOutcome::tooFewPoints, {}};

    const Placement placement(points);
    const Matrix5   r           = factorOfDesign(points, placement);
    const double    rowRounding = kRowRounding * placement.rounding;

    const Eigen::JacobiSVD<Eigen::Matrix3d> positions(r.topLeftCorner<3, 3>(), Eigen::ComputeFullV);
    if (positions.singularValues()[1] <= rowRounding) return {FitOutcome::line, {}};

    // Rows off by rowRounding move the vector of the smallest singular value by rowRounding over the next one.
    const Eigen::JacobiSVD<Matrix5> design(r, Eigen::ComputeFullV);
    const double                    nextSingular = design.singularValues()[3];
    if (rowRounding >= kUndetermined * nextSingular) return {FitOutcome::ring, {}};

    const Vector5   u     = prattVector(design);
    const bool      plane = 2 * std::abs(u[kSquare]) * nextSingular <= rowRounding;
    SphereFitResult result;
    result.outcome    = plane ? FitOutcome::plane : FitOutcome::sphere;
    result.fit        = plane ? planeThrough(placement, positions.matrixV().col(2)) : sphereFrom(placement, u);
    result.fit.misfit = rootMeanSquareDistance(result.fit, points);
    return result;
}

} // namespace palp
