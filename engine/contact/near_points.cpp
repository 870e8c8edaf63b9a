#include "engine/contact/near_points.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/contact/local_spacing.h"

namespace palp {
namespace {

/// The ball is searched this much larger than asked for, so that the next balls lie in it too [1]. At 0.1 spacings per
/// tick one search then serves 15 ticks.
constexpr double kReserve = 1.4;

/// A ball held from a place with a hole is given up when one so much smaller is asked for [1].
constexpr double kTooLarge = 3;

} // namespace

NearPoints::NearPoints(std::span<const glm::dvec3> positions, const NeighbourIndex& index)
    : index_(index), tree_(positions, localSpacings(positions, index))
{
    held_.reserve(kMost);
}

void NearPoints::cover(const glm::dvec3& centre, double radius, int level)
{
    const bool covered = glm::length(centre - centre_) + radius <= radius_ && radius_ <= kTooLarge * radius;
    if (covered && level == asked_) return;
    centre_ = centre;
    radius_ = kReserve * radius;
    asked_  = level;
    for (bool full = true; full && level < tree_.levels(); ++level) {
        held_.clear();
        full = false;
        tree_.inside(centre_, radius_, level, [&](const NearPoint& point) {
            full = held_.size() == kMost;
            if (!full) held_.push_back({point.position, std::max(point.spacing, tree_.cell(level))});
            return !full;
        });
    }
}

} // namespace palp
