#include "engine/contact/detail/near_points.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// The ball that is searched is this many times larger than the one asked for, so that the next balls lie in it too
/// [1]. At 0.1 spacings per tick one search then serves 15 ticks.
constexpr double kReserve = 1.4;

/// A ball kept from a place with a hole is given up when a ball this many times smaller is asked for [1].
constexpr double kTooLarge = 3;

} // namespace

NearPoints::NearPoints(const ContactPoints& points)
    : spacing_(points.usualSpacing()), tree_(points.positions(), points.spacings(), points.marks())
{
    for (Ball& ball : balls_) ball.points.reserve(kMost);
}

std::span<const NearPoint> NearPoints::cover(const glm::dvec3& centre, double radius, int level)
{
    Ball&      ball    = balls_[std::size_t(level) % balls_.size()];
    const bool covered = glm::length(centre - ball.centre) + radius <= ball.radius && ball.radius <= kTooLarge * radius;
    if (covered && level == ball.level) return ball.points;
    ball.centre = centre;
    ball.radius = kReserve * radius;
    ball.level  = level;
    for (bool full = true; full && level < tree_.levels(); ++level) {
        ball.points.clear();
        full = false;
        tree_.inside(ball.centre, ball.radius, level, [&](const NearPoint& point) {
            full = ball.points.size() == kMost;
            if (!full) ball.points.push_back({point.position, std::max(point.spacing, tree_.cell(level)), point.mark});
            return !full;
        });
    }
    return ball.points;
}

} // namespace palp
