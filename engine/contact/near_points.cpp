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
    : positions_(positions), index_(index), spacings_(localSpacings(positions, index)),
      largest_(*std::max_element(spacings_.begin(), spacings_.end()))
{
    found_.reserve(positions.size());
    held_.reserve(std::min(positions.size(), kMost));
}

void NearPoints::cover(const glm::dvec3& centre, double radius)
{
    if (glm::length(centre - centre_) + radius <= radius_ && radius_ <= kTooLarge * radius) return;
    centre_ = centre;
    radius_ = kReserve * radius;
    index_.gather(centre_, radius_, found_);
    std::sort(found_.begin(), found_.end());
    const std::size_t stride = (found_.size() + kMost - 1) / kMost;
    held_.clear();
    for (std::size_t i = 0; i < found_.size(); i += stride)
        held_.push_back({positions_[found_[i]], spacings_[found_[i]]});
}

} // namespace palp
