#include "engine/session/approach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// The plane of the surface by a place.
struct Plane {
    glm::dvec3 point{};  ///< [m] of the cloud, nearest to the place
    glm::dvec3 normal{}; ///< [1] towards the hand

    [[nodiscard]] double     height(const glm::dvec3& p) const { return glm::dot(p - point, normal); }
    [[nodiscard]] glm::dvec3 foot(const glm::dvec3& p) const { return p - height(p) * normal; }
};

/// \param side  [1] where the hand is; of the survey's normals most have no sign
Plane planeBy(const SoftObject& object, const glm::dvec3& place, const glm::dvec3& side)
{
    const std::size_t nearest = object.index().nearest(place, 1).front().point;
    Plane             plane{object.positions()[nearest], object.survey().normal(nearest)};
    if (plane.normal == glm::dvec3(0)) plane.normal = side;
    if (glm::dot(plane.normal, side) < 0) plane.normal = -plane.normal;
    return plane;
}

} // namespace

std::optional<Landing> landingOf(const SoftObject& object, const FreeHand& hand, double lead)
{
    constexpr double kNear = 15e-3, kLeadsNear = 1.5; // [m], [1]; see the header

    const glm::dvec3 beside =
        hand.position - object.positions()[object.index().nearest(hand.position, 1).front().point];
    const double away = glm::length(beside), speed = glm::length(hand.velocity);
    if (!(away <= std::max(kNear, kLeadsNear * lead * speed)) || away == 0) return {};

    const Plane      below   = planeBy(object, hand.position, beside / away);
    const double     closing = -glm::dot(hand.velocity, below.normal);
    const double     until   = closing > 0 ? std::max(0.0, below.height(hand.position)) / closing
                                           : std::numeric_limits<double>::infinity(); // [s]
    const double     free    = std::min(lead, until);
    const glm::dvec3 meets   = hand.position + free * hand.velocity;
    const Plane      there   = planeBy(object, meets, below.normal);
    const glm::dvec3 slides  = hand.velocity - glm::dot(hand.velocity, there.normal) * there.normal;
    return Landing{there.foot(meets) + (lead - free) * slides, there.normal};
}

} // namespace palp
