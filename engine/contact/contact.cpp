#include "engine/contact/contact.h"

#include <sstream>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

std::string inMetres(const glm::dvec3& p)
{
    std::ostringstream text;
    text << "(" << p.x << ", " << p.y << ", " << p.z << ") m";
    return text.str();
}

/// Returns the normal, at the point, of the ellipsoid that fills the bounds: right for closed objects and for thin ones
/// with two sides. A flat sheet has no inside: there it is the axis across.
glm::dvec3 awayFromMiddle(const Bounds& bounds, const glm::dvec3& point)
{
    constexpr double kFlat   = 1e-3; // of the bounds' diagonal; a sheet of paper has less
    constexpr double kMiddle = 0.1;  // of the ellipsoid: a surface that passes there has it on either side
    const glm::dvec3 half    = 0.5 * (bounds.high - bounds.low);
    const glm::dvec3 offset  = point - bounds.centre();
    for (int k = 2; k >= 0; --k)
        if (half[k] < kFlat * bounds.diagonal()) return {k == 0, k == 1, k == 2};
    if (glm::length(offset / half) < kMiddle) return {0, 0, 1};
    return glm::normalize(offset / (half * half));
}

/// Returns the foot of a place on the plane of its nearest point; the point itself where the foot is farther from it
/// than places between points are, so beyond a rim, or where there is no plane.
glm::dvec3 footOf(const SoftObject& object, const glm::dvec3& place, const Neighbour& nearest)
{
    constexpr double     kMost = 1.5; // spacings: of places among random points one in a thousand is farther off [1]
    const glm::dvec3     point = object.positions()[nearest.point];
    const SurfaceSurvey& seen  = object.survey();
    if (seen.spacings().empty()) return point;
    const glm::dvec3 normal = seen.normal(nearest.point), off = place - point;
    if (normal == glm::dvec3(0)) return point; // of points that span no plane
    const glm::dvec3 beside = off - glm::dot(off, normal) * normal;
    return glm::length(beside) <= kMost * seen.spacing(nearest.point) ? point + beside : point;
}

} // namespace

Contact touchAt(const SoftObject& object, const glm::dvec3& place, const std::optional<glm::dvec3>& from, double reach)
{
    const Neighbour  nearest = object.index().nearest(place, 1).front();
    const glm::dvec3 point   = object.positions()[nearest.point];
    const Bounds&    bounds  = object.cloud().bounds();
    if (!(nearest.distance <= reach))
        throw Error("contact: the place " + inMetres(place) + " is " + formatQuantity(nearest.distance, "m") +
                    " from the cloud, expected at most " + formatQuantity(reach, "m") +
                    "; is --length-unit right? The nearest point is " + inMetres(point) + "; the cloud spans " +
                    inMetres(bounds.low) + " to " + inMetres(bounds.high));
    if (from && !(glm::length(*from) > 0)) throw Error("contact: expected a direction, found the zero vector");
    const glm::dvec3 foot = footOf(object, place, nearest);
    return {foot, from ? glm::normalize(*from) : awayFromMiddle(bounds, foot), from.has_value()};
}

} // namespace palp
