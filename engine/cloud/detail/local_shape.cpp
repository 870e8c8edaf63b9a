#include "engine/cloud/detail/local_shape.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr std::size_t kFewestInLayer = 4;   // points: fewer are strays
constexpr double      kClearGap      = 3;   // [1] between two layers, over the deviation within either
constexpr double      kLeastGap      = 0.2; // [spacing] between two layers
constexpr double      kOverlap       = 1.8; // [spacing] least way along the surface to the other layer's nearest point:
                                            // beside a step or across a ridge it is farther
constexpr int         kLayerRounds = 2;     // the first plane lies askew where the other layer took part
constexpr std::size_t kMostQuadric = 64;    // points; of more, evenly spread ones are taken

/// The principal axes of some points.
struct Axes {
    glm::dvec3 normal{}, u{}, v{};              ///< [1] unit, right-handed
    double     least = 0, middle = 0, most = 0; ///< [m^2] variances
};

Axes principalAxes(std::span<const glm::dvec3> points, double radius)
{
    double     weight = 0;
    glm::dvec3 mean{};
    const auto weightOf = [&](const glm::dvec3& p) {
        const double share = std::max(0.05, 1 - glm::dot(p, p) / (radius * radius));
        return share * share;
    };
    for (const glm::dvec3& p : points) {
        const double w = weightOf(p);
        weight += w;
        mean += w * p;
    }
    mean /= weight;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const glm::dvec3& p : points) {
        const double     w = weightOf(p);
        const glm::dvec3 d = p - mean;
        sum(0, 0) += w * d.x * d.x;
        sum(1, 0) += w * d.x * d.y;
        sum(1, 1) += w * d.y * d.y;
        sum(2, 0) += w * d.x * d.z;
        sum(2, 1) += w * d.y * d.z;
        sum(2, 2) += w * d.z * d.z;
    }
    sum /= weight;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(sum);
    const auto axis = [&](int k) {
        return glm::dvec3(eigen.eigenvectors()(0, k), eigen.eigenvectors()(1, k), eigen.eigenvectors()(2, k));
    };
    Axes axes;
    axes.normal = glm::normalize(axis(0));
    axes.u      = glm::normalize(axis(2) - glm::dot(axis(2), axes.normal) * axes.normal);
    axes.v      = glm::cross(axes.normal, axes.u);
    axes.least  = std::max(0.0, eigen.eigenvalues()[0]);
    axes.middle = eigen.eigenvalues()[1];
    axes.most   = eigen.eigenvalues()[2];
    return axes;
}

double meanHeight(std::span<const glm::dvec3> points, const glm::dvec3& normal)
{
    double sum = 0;
    for (const glm::dvec3& p : points) sum += glm::dot(normal, p);
    return sum / double(points.size());
}

/// Sets residual and middle of a shape from a quadric over its plane, or from the plane where points are few.
void fitQuadric(LocalShape& shape, std::span<const glm::dvec3> points, const Axes& axes, double radius)
{
    using Row                          = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Row                         right  = Row::Zero();
    double                      square = 0;
    const std::size_t           step   = (points.size() + kMostQuadric - 1) / kMostQuadric;
    int                         count  = 0;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const double a = glm::dot(axes.u, points[i]) / radius, b = glm::dot(axes.v, points[i]) / radius;
        const double h = glm::dot(axes.normal, points[i]);
        const Row    row{1, a, b, a * a, a * b, b * b};
        normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
        right += h * row;
        square += h * h;
        ++count;
    }
    constexpr int    kUnknowns = 6;
    constexpr double kRidge    = 1e-9; // [1] of the count: points on a line must not blow up
    normal.diagonal().array() += kRidge * count;
    const Row x     = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    shape.middle    = x[0];
    const double ss = std::max(0.0, square - x.dot(right));
    if (count > kUnknowns + 2) shape.residual = std::sqrt(ss / (count - kUnknowns));
}

} // namespace

/// Keeps in own_ the points of the layer in which the middle point lies; returns false if there is one layer only.
bool ShapeFitter::keepOwnLayer(std::span<const glm::dvec3> away, const glm::dvec3& normal, double spacing)
{
    heights_.clear();
    for (std::size_t i = 0; i < away.size(); ++i) heights_.push_back({glm::dot(normal, away[i]), i});
    if (heights_.size() < 2 * kFewestInLayer) return false;
    std::sort(heights_.begin(), heights_.end(), [](const Height& a, const Height& b) { return a.height < b.height; });
    std::size_t cut = 0; // of the points below the widest gap
    double      gap = 0; // [m]
    for (std::size_t k = kFewestInLayer; k + kFewestInLayer <= heights_.size(); ++k)
        if (const double g = heights_[k].height - heights_[k - 1].height; g > gap) {
            gap = g;
            cut = k;
        }
    if (!(gap > kLeastGap * spacing)) return false;
    const auto deviation = [&](std::size_t begin, std::size_t end) {
        double mean = 0, square = 0;
        for (std::size_t k = begin; k < end; ++k) mean += heights_[k].height / double(end - begin);
        for (std::size_t k = begin; k < end; ++k) square += (heights_[k].height - mean) * (heights_[k].height - mean);
        return std::sqrt(square / double(end - begin));
    };
    if (gap < kClearGap * std::max(deviation(0, cut), deviation(cut, heights_.size()))) return false;
    const bool above = heights_[cut - 1].height < 0; // the middle point has height 0
    // The other layer must lie under or over this point, not beside it.
    bool over = false;
    for (std::size_t k = above ? 0 : cut; k < (above ? cut : heights_.size()) && !over; ++k) {
        const glm::dvec3 along = away[heights_[k].point] - heights_[k].height * normal;
        over                   = glm::dot(along, along) < kOverlap * kOverlap * spacing * spacing;
    }
    if (!over) return false;
    own_.clear();
    for (std::size_t k = above ? cut : 0; k < (above ? heights_.size() : cut); ++k)
        own_.push_back(away[heights_[k].point]);
    return true;
}

LocalShape ShapeFitter::fit(std::span<const glm::dvec3> away, double radius, double spacing)
{
    LocalShape shape;
    if (away.size() < kFewestInLayer) return shape;
    own_.assign(away.begin(), away.end());
    Axes axes = principalAxes(own_, radius);
    for (int round = 0; round < kLayerRounds; ++round) {
        shape.sided = keepOwnLayer(away, axes.normal, spacing);
        if (!shape.sided) break;
        axes = principalAxes(own_, radius);
    }
    if (!(axes.most > 0) || !std::isfinite(axes.most)) return {};
    shape.narrow = std::max(0.0, axes.middle) / axes.most;
    shape.normal = axes.normal;
    fitQuadric(shape, own_, axes, radius);
    if (shape.sided && meanHeight(own_, shape.normal) < meanHeight(away, shape.normal)) {
        shape.normal = -shape.normal;
        shape.middle = -shape.middle;
    }
    return shape;
}

} // namespace palp
