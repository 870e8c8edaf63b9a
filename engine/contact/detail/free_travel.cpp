#include "engine/contact/detail/free_travel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr int kRounds = 200; ///< per tick; a catch after a jump of 60 spacings takes up to 94

/// A surface further below the proxy than this is dropped, and the ball finds it again [spacings].
constexpr double kHoldHeight = 1.0;

/// Number of fits after a step at which the surface was further away than kHoldHeight.
constexpr int kFitsFromAfar = 3;

/// Longest way that the ball rolls in a round [largest spacing]: it bounds the search along a way close over a sheet.
constexpr double kLongestRoll = 24;

/// Moves at most `longest` [m] towards the goal.
glm::dvec3 stepTowards(const glm::dvec3& from, const glm::dvec3& to, double longest) noexcept
{
    const double way = glm::length(to - from);
    return way <= longest ? to : from + (longest / way) * (to - from);
}

double highest(const Surfaces& surfaces, const glm::dvec3& place) noexcept
{
    double height = 0;
    for (const SurfacePlane& plane : surfaces.all()) height = std::max(height, plane.height(place));
    return height;
}

/// Returns the surface that the place is furthest behind; null if it is behind none.
const SurfacePlane* passed(const Surfaces& surfaces, const glm::dvec3& place) noexcept
{
    const SurfacePlane* deepest = nullptr;
    for (const SurfacePlane& plane : surfaces.all())
        if (plane.height(place) < 0 && (!deepest || plane.height(place) < deepest->height(place))) deepest = &plane;
    return deepest;
}

} // namespace

/// Moves the ball to its first touch with a point that is not yet in it.
glm::dvec3 FreeTravel::roll(const glm::dvec3& from, const glm::dvec3& goal) noexcept
{
    const double     largest = points_.largestSpacing();
    const glm::dvec3 to      = stepTowards(from, goal, kLongestRoll * largest);
    const glm::dvec3 way     = to - from;
    const double     share   = points_.firstTouch(from, to);
    if (!(share < 1)) return to;
    // A touch must put the point into the ball, or the next round would meet the same point again: also far from the
    // origin, where less than the coordinates' last digit is no step.
    constexpr double kInto = 1e-9, kDigits = 4; // [largest spacing]; [last digits of the largest coordinate]
    const double     most = std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)});
    const double     into = std::max(kInto * largest, kDigits * std::numeric_limits<double>::epsilon() * most);
    return stepTowards(from + share * way, to, into);
}

Arrival FreeTravel::go(const glm::dvec3& from, const glm::dvec3& to, Surfaces& surfaces) noexcept
{
    glm::dvec3 place = from;
    for (int round = 0; round < kRounds; ++round) {
        if (place == to) return {place, false, true, 0};
        const bool blocked = tracker_.discover(surfaces, place, to);
        if (surfaces.count == 0) {
            const double spacing = surfaces.spacing > 0 ? surfaces.spacing : points_.usualSpacing();
            place                = blocked ? stepTowards(place, to, kStepCap * spacing) : roll(place, to);
            continue;
        }
        const int fits = highest(surfaces, place) > kHoldHeight * surfaces.spacing ? kFitsFromAfar : 1;
        place          = stepTowards(place, to, kStepCap * surfaces.spacing);
        for (int fit = 0; fit < fits; ++fit) tracker_.refresh(surfaces, place);
        for (int j = surfaces.count - 1; j >= 0; --j) {
            const SurfacePlane& plane = surfaces.planes[std::size_t(j)];
            if (plane.support == 0 || plane.height(place) > kHoldHeight * surfaces.spacing) surfaces.remove(j);
        }
        if (const SurfacePlane* plane = passed(surfaces, place)) {
            surfaces.seen = {};
            return {place, true, false, plane->support};
        }
    }
    return {place, false, place == to, 0};
}

} // namespace palp
