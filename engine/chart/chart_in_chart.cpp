#include "engine/chart/chart_in_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

namespace palp {

std::optional<ChartInChart> ChartInChart::fitted(std::span<const PlaceInBoth> places, double radius)
{
    constexpr Eigen::Index kTerms = 6, kFewest = 2 * kTerms;
    constexpr double       kFlat = 1e-3; // of the largest column: points along a line determine no second axis [1]
    const auto             count = Eigen::Index(places.size());
    if (count < kFewest) return {};
    Eigen::MatrixXd design(count, kTerms);
    Eigen::MatrixXd right(count, 2);
    double          weights = 0;
    for (Eigen::Index n = 0; n < count; ++n) {
        const PlaceInBoth& place = places[std::size_t(n)];
        const double       x = place.own.x / radius, z = place.own.z / radius, root = std::sqrt(place.weight);
        design.row(n) << root, root * x, root * z, root * x * x, root * x * z, root * z * z;
        right.row(n) << root * place.other.x, root * place.other.z;
        weights += place.weight;
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(design);
    factor.setThreshold(kFlat);
    if (factor.rank() < kTerms) return {};
    const Eigen::MatrixXd found = factor.solve(right);
    const auto            of    = [&](Eigen::Index k) {
        return Polynomial{found(0, k), found(1, k), found(2, k), found(3, k), found(4, k), found(5, k)};
    };
    ChartInChart lies;
    lies.radius_ = radius;
    lies.x_      = of(0);
    lies.z_      = of(1);
    lies.misfit_ = std::sqrt((design * found - right).squaredNorm() / weights);
    return lies;
}

ChartPoint ChartInChart::at(const ChartPoint& own) const noexcept
{
    const double x = own.x / radius_, z = own.z / radius_;
    const auto   of = [&](const Polynomial& p) {
        return p.constant + p.x * x + p.z * z + p.xx * x * x + p.xz * x * z + p.zz * z * z;
    };
    return {of(x_), of(z_)};
}

double ChartInChart::stretchAt(const ChartPoint& own) const noexcept
{
    // Singular values of the Jacobian: half the sum and half the difference of two lengths.
    const double u = own.x / radius_, v = own.z / radius_;
    const auto   alongX = [&](const Polynomial& p) { return (p.x + 2 * p.xx * u + p.xz * v) / radius_; };
    const auto   alongZ = [&](const Polynomial& p) { return (p.z + p.xz * u + 2 * p.zz * v) / radius_; };
    const double xx = alongX(x_), xz = alongZ(x_), zx = alongX(z_), zz = alongZ(z_);
    if (!(xx * zz - xz * zx > 0)) return std::numeric_limits<double>::infinity();
    const double sum = std::hypot(xx + zz, zx - xz) / 2, difference = std::hypot(xx - zz, zx + xz) / 2;
    return std::max(std::abs(sum + difference - 1), std::abs(sum - difference - 1));
}

} // namespace palp
