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

template <int Size>
using Matrix  = Eigen::Matrix<double, Size, Size>;
using Matrix3 = Matrix<3>;
using Matrix4 = Matrix<4>;
using Matrix5 = Matrix<5>;
using Vector5 = Eigen::Matrix<double, 5, 1>;

// Order of the unknowns. Position is first, so that the leading 3x3 block of R is the factor of the positions alone.
enum Column { kX, kY, kZ, kSquare, kOne };

// The same about an anchor, where there is no constant. The square is first, so that the trailing 3x3 block of R is
// what is left of the positions once the best coefficient of the square is put in.
enum AnchoredColumn { kAnchoredSquare, kAnchoredX, kAnchoredY, kAnchoredZ };

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

std::string words(const glm::dvec3& p)
{
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
}

bool isFinite(const glm::dvec3& p)
{
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void expectFinite(std::span<const glm::dvec3> points)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        PALP_EXPECT(isFinite(points[i]),
                    "point " + std::to_string(i) + " of " + std::to_string(points.size()) + " is " + words(points[i]));
}

void expectWeights(std::span<const double> weights, std::size_t points)
{
    PALP_EXPECT(weights.size() == points,
                std::to_string(weights.size()) + " weights for " + std::to_string(points) + " points");
    for (std::size_t i = 0; i < weights.size(); ++i)
        PALP_EXPECT(std::isfinite(weights[i]) && weights[i] >= 0, "weight " + std::to_string(i) + " of " +
                                                                      std::to_string(points) + " is " +
                                                                      std::to_string(weights[i]));
}

/// Counts distinct places, up to four.
class Distinct {
public:
    /// Returns whether this place is the fourth.
    bool add(const glm::dvec3& p)
    {
        if (std::find(seen_.begin(), seen_.begin() + count_, p) != seen_.begin() + count_) return false;
        if (count_ == seen_.size()) return true;
        seen_[count_++] = p;
        return false;
    }

private:
    std::array<glm::dvec3, 3> seen_;
    std::size_t               count_ = 0;
};

bool hasFourDistinct(std::span<const glm::dvec3> points)
{
    Distinct distinct;
    return std::any_of(points.begin(), points.end(), [&](const glm::dvec3& p) { return distinct.add(p); });
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

/// Computes R of design = Q R by Householder on a fixed block of rows below the R so far: constant memory. R stays
/// triangular by itself, because a reflection leaves alone the rows that are zero in its column.
/// \param row  (i) gives row i of the design
template <int Columns, class Row>
Matrix<Columns> factorOfRows(std::size_t rows, const Row& row)
{
    constexpr int kBlock = 64; // rows: long enough to hide the few rows carried along, short enough for the stack
    using Stack          = Eigen::Matrix<double, Columns + kBlock, Columns>;
    Stack stack          = Stack::Zero();
    for (std::size_t begin = 0; begin < rows; begin += kBlock) {
        const std::size_t count = std::min<std::size_t>(kBlock, rows - begin);
        stack.template bottomRows<kBlock>().setZero();
        for (std::size_t i = 0; i < count; ++i) stack.row(Columns + int(i)) = row(begin + i);
        Eigen::HouseholderQR<Eigen::Ref<Stack>> inPlace(stack);
    }
    return stack.template topRows<Columns>();
}

/// Computes R of the design, divided by the square root of the number of points so that it does not grow with it.
Matrix5 factorOfDesign(std::span<const glm::dvec3> points, const Placement& placement)
{
    const double weight = 1 / std::sqrt(double(points.size()));
    return factorOfRows<5>(points.size(), [&](std::size_t i) {
        const glm::dvec3 x = (points[i] - placement.centroid) / placement.scale;
        return Eigen::Matrix<double, 1, 5>{{weight * x.x, weight * x.y, weight * x.z, weight * glm::dot(x, x), weight}};
    });
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

SphereFit planeThrough(const glm::dvec3& reference, const Eigen::Vector3d& normal)
{
    // The one of the two normals whose largest component is positive, so that the answer does not depend on rounding.
    Eigen::Index largest = 0;
    normal.cwiseAbs().maxCoeff(&largest);
    const Eigen::Vector3d n = normal * std::copysign(1.0, normal[largest]);

    SphereFit plane;
    plane.reference = reference;
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

/// Points seen from an anchor: x = (p - anchor) / scale has weighted root mean square 1.
class Anchored {
public:
    Anchored(const glm::dvec3& anchor, std::span<const glm::dvec3> points, std::span<const double> weights)
        : anchor_(anchor), points_(points), weights_(weights)
    {
        // As ratios to the largest, weights and distances stay in the range of doubles when they are squared and added.
        double farthest = largestCoordinate(anchor), extent = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (weights[i] == 0) continue;
            heaviest_ = std::max(heaviest_, weights[i]);
            farthest  = std::max(farthest, largestCoordinate(points[i]));
            extent    = std::max(extent, largestCoordinate(points[i] - anchor));
        }
        double sum = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (weights[i] == 0) continue;
            const glm::dvec3 q = (points[i] - anchor) / extent;
            total_ += weights[i] / heaviest_;
            sum += weights[i] / heaviest_ * glm::dot(q, q);
        }
        scale_    = extent * std::sqrt(sum / total_);
        rounding_ = std::numeric_limits<double>::epsilon() * std::max(1.0, farthest / scale_);
    }

    [[nodiscard]] double scale() const noexcept { return scale_; }       ///< [m]
    [[nodiscard]] double rounding() const noexcept { return rounding_; } ///< [1] of x, as Placement's

    /// Computes R of the design, whose rows are those of AnchoredColumn times the root of their share in all weights.
    [[nodiscard]] Matrix4 factor() const
    {
        return factorOfRows<4>(points_.size(), [&](std::size_t i) -> Eigen::RowVector4d {
            if (weights_[i] == 0) return Eigen::RowVector4d::Zero();
            const double     root = std::sqrt(share(i));
            const glm::dvec3 x    = (points_[i] - anchor_) / scale_;
            return {root * glm::dot(x, x), root * x.x, root * x.y, root * x.z};
        });
    }

    /// Returns the weighted root mean square distance of the points from a surface [m].
    [[nodiscard]] double misfit(const SphereFit& fit) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (weights_[i] == 0) continue;
            const double distance = fit.signedDistance(points_[i]) / scale_;
            sum += share(i) * distance * distance;
        }
        return scale_ * std::sqrt(sum);
    }

private:
    [[nodiscard]] double share(std::size_t i) const { return weights_[i] / heaviest_ / total_; }

    glm::dvec3                  anchor_; ///< [m]
    std::span<const glm::dvec3> points_; ///< [m]
    std::span<const double>     weights_;
    double                      heaviest_ = 0; ///< of the weights
    double                      total_    = 0; ///< of the weights, over the heaviest
    double                      scale_    = 0;
    double                      rounding_ = 0;
};

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

    const Eigen::JacobiSVD<Matrix3> positions(r.topLeftCorner<3, 3>(), Eigen::ComputeFullV);
    if (positions.singularValues()[1] <= rowRounding) return {FitOutcome::line, {}};

    // Rows off by rowRounding move the vector of the smallest singular value by rowRounding over the next one.
    const Eigen::JacobiSVD<Matrix5> design(r, Eigen::ComputeFullV);
    const double                    nextSingular = design.singularValues()[3];
    if (rowRounding >= kUndetermined * nextSingular) return {FitOutcome::ring, {}};

    const Vector5   u     = prattVector(design);
    const bool      plane = 2 * std::abs(u[kSquare]) * nextSingular <= rowRounding;
    SphereFitResult result;
    result.outcome    = plane ? FitOutcome::plane : FitOutcome::sphere;
    result.fit        = plane ? planeThrough(placement.centroid, positions.matrixV().col(2)) : sphereFrom(placement, u);
    result.fit.misfit = rootMeanSquareDistance(result.fit, points);
    return result;
}

SphereFitResult fitSphereThrough(const glm::dvec3& anchor, std::span<const glm::dvec3> points,
                                 std::span<const double> weights)
{
    PALP_EXPECT(isFinite(anchor), "the anchor is " + words(anchor));
    expectFinite(points);
    expectWeights(weights, points.size());
    Distinct distinct;
    bool     enough = distinct.add(anchor);
    for (std::size_t i = 0; i < points.size() && !enough; ++i) enough = weights[i] > 0 && distinct.add(points[i]);
    if (!enough) return {FitOutcome::tooFewPoints, {}};

    const Anchored anchored(anchor, points, weights);
    const Matrix4  r           = anchored.factor();
    const double   rowRounding = kRowRounding * anchored.rounding();

    const Eigen::JacobiSVD<Eigen::Matrix<double, 4, 3>> positions(r.rightCols<3>(), Eigen::ComputeFullV);
    if (positions.singularValues()[1] <= rowRounding) return {FitOutcome::line, {}};

    // Whatever u is, the best u0 makes the first element of R (u0, u) vanish; the others do not contain u0.
    const Eigen::JacobiSVD<Matrix3> rest(r.bottomRightCorner<3, 3>(), Eigen::ComputeFullV);
    const double                    nextSingular = rest.singularValues()[1];
    if (rowRounding >= kUndetermined * nextSingular) return {FitOutcome::ring, {}};

    const Eigen::Vector3d u      = rest.matrixV().col(2);
    const double          square = -r.row(0).tail<3>().dot(u) / r(kAnchoredSquare, kAnchoredSquare);
    const bool            plane  = 2 * std::abs(square) * nextSingular <= rowRounding;

    SphereFitResult result;
    result.outcome = plane ? FitOutcome::plane : FitOutcome::sphere;
    if (plane) {
        result.fit = planeThrough(anchor, positions.matrixV().col(2));
    } else {
        const double sign    = std::copysign(1.0, square);
        result.fit.reference = anchor;
        result.fit.curvature = sign * 2 * square / anchored.scale();
        result.fit.gradient  = sign * glm::dvec3(u[0], u[1], u[2]);
    }
    result.fit.misfit = anchored.misfit(result.fit);
    return result;
}

} // namespace palp
