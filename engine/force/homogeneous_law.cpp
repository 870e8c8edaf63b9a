#include "engine/force/homogeneous_law.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {

HomogeneousLaw::HomogeneousLaw(std::vector<Site> sites, double cell, bool stiffens) : cell_(cell), stiffens_(stiffens)
{
    PALP_EXPECT(cell > 0 && !sites.empty(),
                std::to_string(sites.size()) + " sites in cells of " + std::to_string(cell) + " m");
    corner_ = sites.front().point;
    for (const Site& site : sites) corner_ = glm::min(corner_, site.point);
    std::vector<std::size_t> order(sites.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(order, {}, [&](std::size_t n) { return std::pair(keyOf(sites[n].point, 0, 0, 0), n); });
    for (const std::size_t n : order) {
        sites_.push_back(sites[n]);
        keys_.push_back(keyOf(sites[n].point, 0, 0, 0));
    }
}

HomogeneousLaw::Key HomogeneousLaw::keyOf(const glm::dvec3& place, int dx, int dy, int dz) const noexcept
{
    constexpr double kMiddle = 1 << 20, kMost = (1 << 21) - 1.0; // 21 bits for each axis
    const auto       along = [&](double x, double from, int d) {
        return Key(std::clamp(std::floor((x - from) / cell_) + d + kMiddle, 0.0, kMost));
    };
    return along(place.x, corner_.x, dx) << 42U | along(place.y, corner_.y, dy) << 21U | along(place.z, corner_.z, dz);
}

std::optional<ComplianceTable::Values> HomogeneousLaw::at(const glm::dvec3& place) const noexcept
{
    constexpr double        kReach = 1.5; // [cells] 27 cubes hold all that is within one cell, and most of the rest
    ComplianceTable::Values sum{0, 0, true};
    double                  weights = 0, stiffening = 0;
    if (!std::isfinite(place.x + place.y + place.z)) return {};
    for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dz = -1; dz <= 1; ++dz) {
                const auto [first, last] = std::equal_range(keys_.begin(), keys_.end(), keyOf(place, dx, dy, dz));
                for (auto key = first; key != last; ++key) {
                    const Site&      site  = sites_[std::size_t(key - keys_.begin())];
                    const glm::dvec3 away  = (site.point - place) / (kReach * cell_);
                    const double     share = std::max(0.0, 1 - glm::dot(away, away));
                    weights += share * share;
                    sum.lnCompliance += share * share * site.lnCompliance;
                    sum.lnContactStiffness += share * share * site.lnContactStiffness;
                    stiffening += share * share * site.stiffening;
                }
            }
    if (!(weights > 0)) return {};
    sum.lnCompliance /= weights;
    sum.lnContactStiffness /= weights;
    if (stiffens_) sum.stiffening = stiffening / weights;
    return sum;
}

} // namespace palp
