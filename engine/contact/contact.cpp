#include "engine/contact/contact.h"

#include <algorithm>
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

/// Away from the middle of the bounds; +z where the object is a sheet, or the point is in its middle.
glm::dvec3 awayFromMiddle(const Bounds& bounds, const glm::dvec3& point)
{
    constexpr double kClearly = 0.05; // of the bounds' diagonal: a ball has 0.58, a sheet of paper next to nothing
    const glm::dvec3 size     = bounds.high - bounds.low;
    const glm::dvec3 offset   = point - bounds.centre();
    const double     clear    = kClearly * bounds.diagonal();
    if (std::min({size.x, size.y, size.z}) < clear || glm::length(offset) < clear) return {0, 0, 1};
    return glm::normalize(offset);
}

} // namespace

Contact touchAt(const PointCloud& cloud, const NeighbourIndex& index, const glm::dvec3& place,
                const std::optional<glm::dvec3>& from, double reach)
{
    const Neighbour  nearest = index.nearest(place, 1).front();
    const glm::dvec3 point   = cloud.positions()[nearest.point];
    if (!(nearest.distance <= reach))
        throw Error("contact: the place " + inMetres(place) + " is " + formatQuantity(nearest.distance, "m") +
                    " from the cloud, expected at most " + formatQuantity(reach, "m") + "; the nearest point is " +
                    inMetres(point) + "; the cloud spans " + inMetres(cloud.bounds().low) + " to " +
                    inMetres(cloud.bounds().high));
    if (from && !(glm::length(*from) > 0)) throw Error("contact: expected a direction, found the zero vector");
    return {point, from ? glm::normalize(*from) : awayFromMiddle(cloud.bounds(), point)};
}

} // namespace palp
