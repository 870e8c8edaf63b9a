#include "engine/cloud/detail/local_shape.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr std::size_t kFewestInLayer = 4;    // points: fewer are strays
constexpr std::size_t kMostInLayers  = 128;  // points: wider balls are searched for noise, not for layers
constexpr double      kClearGap      = 3;    // [1] between two layers, over the deviation within either
constexpr double      kLeastGap      = 0.2;  // [spacing] between two layers
constexpr double      kThin          = 0.08; // [spacing] points that deviate less from a plane are not two layers
constexpr double      kOverlap       = 1.8; // [spacing] least way along the surface to the other layer's nearest point:
                                            // beside a step or across a ridge it is farther
constexpr int         kLayerRounds = 4;     // the first plane lies askew, by as much as the layers are apart
constexpr std::size_t kMostQuadric = 256;   // points; of more, evenly spread ones are taken
constexpr int         kForTails    = 40;    // points: fewer tell nothing about tails

/// The principal axes of some points.
struct Axes {
    glm::dvec3 normal{}, u{}, v{};              ///< [1] unit, right-handed
    double     least = 0, middle = 0, most = 0; ///< [m^2] variances
};

/// Weighted first and second moments of some points.
struct Moments {
    double          weight = 0;
    glm::dvec3      mean{};                           ///< [m]
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero(); ///< about the mean, lower half [m^2], times the weight
};

template <class Points>
Moments momentsOf(const Points& points, double radius)
{
    Moments    m;
    const auto weightOf = [&](const glm::dvec3& p) {
        const double share = std::max(0.05, 1 - glm::dot(p, p) / (radius * radius));
        return share * share;
    };
    for (const glm::dvec3& p : points) {
        const double w = weightOf(p);
        m.weight += w;
        m.mean += w * p;
    }
    m.mean /= m.weight;
    for (const glm::dvec3& p : points) {
        const double     w = weightOf(p);
        const glm::dvec3 d = p - m.mean;
        m.square(0, 0) += w * d.x * d.x;
        m.square(1, 0) += w * d.x * d.y;
        m.square(1, 1) += w * d.y * d.y;
        m.square(2, 0) += w * d.x * d.z;
        m.square(2, 1) += w * d.y * d.z;
        m.square(2, 2) += w * d.z * d.z;
    }
    return m;
}

Axes axesOf(const Eigen::Matrix3d& variance)
{
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(variance);
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

/// Sets residual and tails of a shape from a quadric over its plane, or from the plane where points are few.
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
    const Row    x  = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    const double ss = std::max(0.0, square - x.dot(right));
    if (count > kUnknowns + 2) shape.residual = std::sqrt(ss / (count - kUnknowns));
    if (count <= kForTails || !(ss > 0)) return;
    double fourth = 0;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const double a = glm::dot(axes.u, points[i]) / radius, b = glm::dot(axes.v, points[i]) / radius;
        const double off = glm::dot(axes.normal, points[i]) - Row{1, a, b, a * a, a * b, b * b}.dot(x);
        fourth += off * off * off * off;
    }
    shape.tails = fourth * count / (ss * ss);
}

} // namespace

/// Sorts the points by height and returns how many lie below the cut that parts them best into two groups (Otsu 1979:
/// the largest variance between the groups).
std::size_t ShapeFitter::cutByHeight(std::span<const glm::dvec3> away, const glm::dvec3& normal)
{
    heights_.clear();
    double all = 0;
    for (std::size_t i = 0; i < away.size(); ++i) {
        heights_.push_back({glm::dot(normal, away[i]), i});
        all += heights_.back().height;
    }
    std::sort(heights_.begin(), heights_.end(), [](const Height& a, const Height& b) { return a.height < b.height; });
    const auto  count = double(away.size());
    std::size_t best  = kFewestInLayer;
    double      most = 0, below = 0;
    for (std::size_t k = 1; k + kFewestInLayer <= heights_.size(); ++k) {
        below += heights_[k - 1].height;
        const double apart   = below / double(k) - (all - below) / (count - double(k));
        const double between = double(k) * (count - double(k)) * apart * apart;
        if (k < kFewestInLayer || between <= most) continue;
        most = between;
        best = k;
    }
    return best;
}

/// Returns true if the groups below and above a cut are two layers, one over the other about the middle point.
bool ShapeFitter::areLayers(std::span<const glm::dvec3> away, const glm::dvec3& normal, double spacing,
                            std::size_t cut) const
{
    const auto deviation = [&](std::size_t begin, std::size_t end) {
        double mean = 0, square = 0;
        for (std::size_t k = begin; k < end; ++k) mean += heights_[k].height / double(end - begin);
        for (std::size_t k = begin; k < end; ++k) square += (heights_[k].height - mean) * (heights_[k].height - mean);
        return std::sqrt(square / double(end - begin));
    };
    const double gap    = heights_[cut].height - heights_[cut - 1].height;
    const double within = std::max(deviation(0, cut), deviation(cut, heights_.size()));
    if (gap < kLeastGap * spacing || gap < kClearGap * within) return false;
    const bool        above = heights_[cut - 1].height < 0;                         // the middle point has height 0
    const std::size_t begin = above ? 0 : cut, end = above ? cut : heights_.size(); // the other layer
    for (std::size_t k = begin; k < end; ++k) {
        const glm::dvec3 along = away[heights_[k].point] - heights_[k].height * normal;
        if (glm::dot(along, along) < kOverlap * kOverlap * spacing * spacing) return true;
    }
    return false;
}

/// Keeps in own_ the points of the layer in which the middle point lies; returns false if there is one layer only.
///
/// The normal of two layers is that of the variance within them, found in turns with the cut between them.
bool ShapeFitter::keepOwnLayer(std::span<const glm::dvec3> away, glm::dvec3 normal, double radius, double spacing)
{
    if (away.size() < 2 * kFewestInLayer) return false;
    for (int round = 0;; ++round) {
        const std::size_t cut = cutByHeight(away, normal);
        if (areLayers(away, normal, spacing, cut)) {
            const bool above = heights_[cut - 1].height < 0;
            own_.clear();
            for (std::size_t k = above ? cut : 0; k < (above ? heights_.size() : cut); ++k)
                own_.push_back(away[heights_[k].point]);
            return true;
        }
        if (round == kLayerRounds) return false;
        const auto group = [&](std::size_t begin, std::size_t end) {
            own_.clear();
            for (std::size_t k = begin; k < end; ++k) own_.push_back(away[heights_[k].point]);
            return momentsOf(own_, radius).square;
        };
        normal = axesOf(group(0, cut) + group(cut, heights_.size())).normal;
    }
}

LocalShape ShapeFitter::fit(std::span<const glm::dvec3> away, double radius, double spacing)
{
    LocalShape shape;
    if (away.size() < kFewestInLayer) return shape;
    const auto planeOf = [&](std::span<const glm::dvec3> points) {
        const Moments moments = momentsOf(points, radius);
        return axesOf(moments.square / moments.weight);
    };
    Axes axes = planeOf(away);
    if (!(axes.most > 0) || !std::isfinite(axes.most)) return shape;
    const bool thick = axes.least > kThin * kThin * spacing * spacing;
    if (thick && away.size() <= kMostInLayers) shape.sided = keepOwnLayer(away, axes.normal, radius, spacing);
    const std::span<const glm::dvec3> own = shape.sided ? std::span<const glm::dvec3>(own_) : away;
    if (shape.sided) axes = planeOf(own);
    shape.narrow = std::max(0.0, axes.middle) / axes.most;
    shape.normal = axes.normal;
    fitQuadric(shape, own, axes, radius);
    if (shape.sided && meanHeight(own, shape.normal) < meanHeight(away, shape.normal)) shape.normal = -shape.normal;
    return shape;
}

} // namespace palp
