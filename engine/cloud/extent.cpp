#include "engine/cloud/extent.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {

Extent extentOf(std::span<const glm::dvec3> points, std::span<const double> spacings)
{
    constexpr int kTimes = 4;
    glm::dvec3    mean{};
    double        all = 0, squares = 0;
    const auto    weight = [&](std::size_t n) { return spacings.empty() ? 1 : spacings[n] * spacings[n]; };
    for (std::size_t n = 0; n < points.size(); ++n) {
        mean += weight(n) * points[n];
        all += weight(n);
    }
    if (!(all > 0)) return {};
    mean /= all;
    for (std::size_t n = 0; n < points.size(); ++n) {
        const glm::dvec3 d = points[n] - mean;
        squares += weight(n) * glm::dot(d, d);
    }
    Extent     extent;
    glm::dvec3 from = mean;
    for (int k = 0; k < kTimes; ++k) {
        double     most = 0;
        glm::dvec3 to   = from;
        for (const glm::dvec3& p : points)
            if (const double away = glm::dot(p - from, p - from); away > most) {
                most = away;
                to   = p;
            }
        extent.across = std::max(extent.across, std::sqrt(most));
        from          = to;
    }
    extent.length = std::min(std::sqrt(12 * squares / all), std::sqrt(2.0) * extent.across);
    return extent;
}

} // namespace palp
