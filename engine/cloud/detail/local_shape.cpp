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
constexpr int kLayerRounds = 4;             // the first plane lies askew, by as much as the layers are apart
// A cut between two layers leaves most of the variance between them [1]: 0.9 and more, that through noise 0.66. Where
// the layers are so far apart that the first plane may stand across them [spacings], that is no sign yet.
constexpr double      kParted = 0.7, kNearlyFlat = 0.6;
constexpr std::size_t kMostQuadric = 256; // points; of more, evenly spread ones are taken
constexpr std::size_t kForSmooth   = 12;  // points: fewer determine no quadric well
constexpr double      kEven        = 0.3; // [1] least ratio of their extents, squared, for that
constexpr int         kForTails    = 40;  // points: fewer tell nothing about tails

// Two faces are so many times as far apart as their points deviate [1]. Half of evenly spread noise is 3.5 times its
// own deviation from the other half, half of Gaussian noise 2.7 times; faces four times their noise apart have 4.4.
constexpr double kFacesApart = 3.8;

// The depth of the other face scatters by so many times this one's deviation at most [1]: as much where they are
// parallel, more where they meet at a rim.
constexpr double kParallel = 1.5;

// The kurtosis of two heaps of similar size is 1 to 1.8 [1]: what is above this needs no cut, which takes a third as
// long as the fits. Gaussian noise has 3, give or take 0.2 in the wide balls.
constexpr double kMayBeFaces = 2.4;

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

Axes axesOf(std::span<const glm::dvec3> points, double radius)
{
    const Moments moments = momentsOf(points, radius);
    return axesOf(moments.square / moments.weight);
}

double meanHeight(std::span<const glm::dvec3> points, const glm::dvec3& normal)
{
    double sum = 0;
    for (const glm::dvec3& p : points) sum += glm::dot(normal, p);
    return sum / double(points.size());
}

/// The sums of a^m b^n over some points that the normal equations of a quadric are made of.
class QuadricSums {
public:
    using Row = Eigen::Matrix<double, 6, 1>;

    void add(double a, double b, double h) noexcept
    {
        const double aa = a * a, ab = a * b, bb = b * b;
        const double powers[kPowers] = {1,      a,      b,       aa,      ab,      bb,      aa * a, aa * b,
                                        ab * b, bb * b, aa * aa, aa * ab, aa * bb, ab * bb, bb * bb};
        for (int k = 0; k < kPowers; ++k) sums_[k] += powers[k];
        for (int k = 0; k < 6; ++k) right_[k] += h * powers[k];
        square_ += h * h;
    }

    [[nodiscard]] Eigen::Matrix<double, 6, 6> matrix(double ridge) const
    {
        // Which sum stands where: row 1, a, b, a^2, a b, b^2 times column.
        static constexpr int        kOf[6][6] = {{0, 1, 2, 3, 4, 5},    {1, 3, 4, 6, 7, 8},    {2, 4, 5, 7, 8, 9},
                                                 {3, 6, 7, 10, 11, 12}, {4, 7, 8, 11, 12, 13}, {5, 8, 9, 12, 13, 14}};
        Eigen::Matrix<double, 6, 6> result;
        for (int r = 0; r < 6; ++r)
            for (int c = 0; c < 6; ++c) result(r, c) = sums_[kOf[r][c]] + (r == c ? ridge * sums_[0] : 0);
        return result;
    }
    [[nodiscard]] Row    right() const { return Row(right_); }
    [[nodiscard]] double square() const noexcept { return square_; }
    [[nodiscard]] int    count() const noexcept { return int(sums_[0]); }

private:
    static constexpr int kPowers = 15;

    double sums_[kPowers] = {}, right_[6] = {}, square_ = 0;
};

/// Sets quadric, residual and tails of a shape from the points about its plane.
void fitQuadric(LocalShape& shape, std::span<const glm::dvec3> points, const Axes& axes, double radius)
{
    constexpr int     kUnknowns = 6;
    constexpr double  kRidge    = 1e-9; // [1] of the count: points on a line must not blow up
    const std::size_t step      = (points.size() + kMostQuadric - 1) / kMostQuadric;
    QuadricSums       sums;
    for (std::size_t i = 0; i < points.size(); i += step)
        sums.add(glm::dot(axes.u, points[i]) / radius, glm::dot(axes.v, points[i]) / radius,
                 glm::dot(axes.normal, points[i]));
    const int count              = sums.count();
    shape.count                  = std::size_t(count);
    const QuadricSums::Row right = sums.right();
    const QuadricSums::Row x     = sums.matrix(kRidge).ldlt().solve(right);
    shape.u                      = axes.u;
    shape.v                      = axes.v;
    std::copy(x.begin(), x.end(), shape.quadric.begin());

    const double ss = std::max(0.0, sums.square() - x.dot(right));
    if (count > kUnknowns + 2) shape.residual = std::sqrt(ss / (count - kUnknowns));
    if (count <= kForTails || !(ss > 0)) return;
    double fourth = 0;
    for (std::size_t i = 0; i < points.size(); i += step) {
        const double a = glm::dot(axes.u, points[i]) / radius, b = glm::dot(axes.v, points[i]) / radius;
        const double off = glm::dot(axes.normal, points[i]) - QuadricSums::Row{1, a, b, a * a, a * b, b * b}.dot(x);
        fourth += off * off * off * off;
    }
    shape.tails = fourth * count / (ss * ss);
}

LocalShape shapeOf(std::span<const glm::dvec3> points, const Axes& axes, double radius)
{
    LocalShape shape;
    shape.narrow = std::max(0.0, axes.middle) / axes.most;
    shape.normal = axes.normal;
    fitQuadric(shape, points, axes, radius);
    return shape;
}

} // namespace

glm::dvec3 LocalShape::normalAt(const glm::dvec3& away, double radius) const noexcept
{
    const double a = glm::dot(u, away) / radius, b = glm::dot(v, away) / radius;
    const double alongU = (quadric[1] + 2 * quadric[3] * a + quadric[4] * b) / radius;
    const double alongV = (quadric[2] + quadric[4] * a + 2 * quadric[5] * b) / radius;
    return glm::normalize(normal - alongU * u - alongV * v);
}

double LocalShape::heightOf(const glm::dvec3& away, double radius) const noexcept
{
    const double a = glm::dot(u, away) / radius, b = glm::dot(v, away) / radius;
    return glm::dot(normal, away) - (quadric[0] + quadric[1] * a + quadric[2] * b + quadric[3] * a * a +
                                     quadric[4] * a * b + quadric[5] * b * b);
}

ShapeFitter::Cut ShapeFitter::cutByHeight(std::span<const glm::dvec3> away, const glm::dvec3& normal)
{
    heights_.clear();
    for (std::size_t i = 0; i < away.size(); ++i) heights_.push_back({glm::dot(normal, away[i]), i});
    return bestCut();
}

/// Sorts the heights and returns the cut that parts them best into two groups (Otsu 1979: the largest variance between
/// the groups).
ShapeFitter::Cut ShapeFitter::bestCut()
{
    double all = 0, square = 0;
    for (const Height& h : heights_) {
        all += h.height;
        square += h.height * h.height;
    }
    std::sort(heights_.begin(), heights_.end(), [](const Height& a, const Height& b) { return a.height < b.height; });
    const auto  count = double(heights_.size());
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
    const double variance = count * square - all * all; // times count^2, as `most` is
    return {best, variance > 0 ? most / variance : 0};
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
/// \param variance  of the heights over the first plane [m^2]
bool ShapeFitter::keepOwnLayer(std::span<const glm::dvec3> away, glm::dvec3 normal, double variance, double radius,
                               double spacing)
{
    if (away.size() < 2 * kFewestInLayer) return false;
    for (int round = 0;; ++round) {
        const auto [cut, share] = cutByHeight(away, normal);
        if (share < kParted && variance < kNearlyFlat * kNearlyFlat * spacing * spacing) return false;
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

LocalShape ShapeFitter::fitFace(std::span<const glm::dvec3> away, double radius, double spacing)
{
    LocalShape both = fit(away, radius, spacing);
    if (away.size() <= kMostInLayers || !(both.residual > 0) || both.tails > kMayBeFaces) return both;
    heights_.clear();
    for (std::size_t i = 0; i < away.size(); ++i) heights_.push_back({both.heightOf(away[i], radius), i});
    const std::size_t cut = bestCut().at;

    const bool above = both.heightOf({}, radius) > (heights_[cut - 1].height + heights_[cut].height) / 2;
    own_.clear();
    for (std::size_t k = above ? cut : 0; k < (above ? heights_.size() : cut); ++k)
        own_.push_back(away[heights_[k].point]);
    LocalShape face = shapeOf(own_, axesOf(own_, radius), radius);
    if (glm::dot(face.normal, both.normal) * (above ? 1 : -1) < 0) {
        face.normal = -face.normal;
        for (double& q : face.quadric) q = -q;
    }
    double     mean = 0, square = 0; // [m] of the other face's depth below this one
    const auto others = double(away.size() - own_.size());
    for (std::size_t k = above ? 0 : cut; k < (above ? cut : heights_.size()); ++k) {
        const double below = -face.heightOf(away[heights_[k].point], radius);
        mean += below / others;
        square += below * below / others;
    }
    const double spread = std::sqrt(std::max(0.0, square - mean * mean));
    if (mean < kFacesApart * face.residual || spread > kParallel * face.residual) return both;
    face.sided = true;
    face.apart = mean;
    return face;
}

LocalShape ShapeFitter::fit(std::span<const glm::dvec3> away, double radius, double spacing)
{
    LocalShape shape;
    if (away.size() < kFewestInLayer) return shape;
    const Axes axes = axesOf(away, radius);
    if (!(axes.most > 0) || !std::isfinite(axes.most)) return shape;
    const bool thick = axes.least > kThin * kThin * spacing * spacing;
    const bool sided =
        thick && away.size() <= kMostInLayers && keepOwnLayer(away, axes.normal, axes.least, radius, spacing);
    const std::span<const glm::dvec3> own = sided ? std::span<const glm::dvec3>(own_) : away;
    shape                                 = shapeOf(own, sided ? axesOf(own, radius) : axes, radius);
    shape.sided                           = sided;
    shape.smooth                          = !thick && own.size() >= kForSmooth && shape.narrow > kEven;
    if (shape.sided && meanHeight(own, shape.normal) < meanHeight(away, shape.normal)) shape.normal = -shape.normal;
    return shape;
}

} // namespace palp
