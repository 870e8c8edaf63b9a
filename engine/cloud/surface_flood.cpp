#include "engine/cloud/surface_flood.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "engine/cloud/local_spacing.h"

namespace palp {

SurfaceFlood::SurfaceFlood(std::span<const glm::dvec3> positions, const NeighbourIndex& index)
    : positions_(positions), index_(index), spacings_(localSpacings(positions, index))
{
}

std::span<const std::uint32_t> SurfaceFlood::reach(const glm::dvec3& centre, double radius)
{
    points_.clear();
    index_.gather(centre, radius, inBall_);
    if (inBall_.empty()) return points_;

    places_.clear();
    steps_.clear();
    double      longest = 0; // [m] step
    double      least2  = std::numeric_limits<double>::infinity();
    std::size_t first   = 0; // nearest to the middle; the lowest index of equally near ones
    for (std::size_t i = 0; i < inBall_.size(); ++i) {
        const glm::dvec3& p = positions_[inBall_[i]];
        const glm::dvec3  d = p - centre;
        places_.push_back(p);
        steps_.push_back(kStep * spacings_[inBall_[i]]);
        longest         = std::max(longest, steps_.back());
        const double d2 = glm::dot(d, d);
        if (d2 < least2 || (d2 == least2 && inBall_[i] < inBall_[first])) {
            least2 = d2;
            first  = i;
        }
    }
    grid_.build(places_, longest);

    // A point that is reached is taken out of the grid, so that all searches together see each point only some times.
    reached_.assign(1, std::uint32_t(first));
    grid_.takeNear(places_[first], 0, [&](std::size_t i, double) { return i == first; });
    for (std::size_t next = 0; next < reached_.size(); ++next) {
        const std::uint32_t from = reached_[next];
        grid_.takeNear(places_[from], longest, [&](std::size_t i, double distance2) {
            const double step = std::max(steps_[from], steps_[i]);
            if (distance2 > step * step) return false;
            reached_.push_back(std::uint32_t(i));
            return true;
        });
    }
    for (const std::uint32_t i : reached_) points_.push_back(inBall_[i]);
    return points_;
}

} // namespace palp
