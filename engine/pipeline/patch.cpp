#include "engine/pipeline/patch.h"

#include <cstdio>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/plate/load.h"

namespace palp {

std::string placeText(const Contact& contact)
{
    char text[96];
    std::snprintf(text, sizeof text, "at (%.4g, %.4g, %.4g) m", contact.point.x, contact.point.y, contact.point.z);
    return text;
}

void demandDeformed(const Patch& patch, const char* hint)
{
    if (patch.deformed()) return;
    throw Error(placeText(patch.contact) + ": the " + std::to_string(patch.gathered.size()) +
                " points nearby do not determine a surface (" + name(patch.sphere.outcome) + "); " + hint);
}

std::string directionText(const glm::dvec3& direction)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.2f,%.2f,%.2f", direction.x, direction.y, direction.z);
    return text;
}

double responseAt(const Patch& patch, const ChartPoint& place)
{
    const ChartPoint& corner = patch.window.corner;
    return patch.window.holds(place)
               ? interpolate(patch.window.grid, patch.response, place.x - corner.x, place.z - corner.z)
               : 0;
}

void eachMoving(const Patch& patch, std::span<const glm::dvec3> positions,
                const std::function<void(std::uint32_t, const ChartPoint&, double)>& visit)
{
    for (std::size_t n = 0; n < patch.points.size(); ++n) {
        if (!patch.coarse) {
            visit(patch.points[n], patch.positions[n], patch.pointResponse[n]);
            continue;
        }
        // A point lies beside its coarse one in the chart as it does on the surface, seen along the chart's normal: they
        // are at most a cell apart.
        const glm::dvec3 middle = patch.coarse->object().positions()[patch.points[n]];
        for (const std::uint32_t member : patch.coarse->membersOf(patch.points[n])) {
            const glm::dvec3 d = positions[member] - middle;
            const ChartPoint place{patch.positions[n].x + glm::dot(d, patch.chart.frame.east),
                                   patch.positions[n].z + glm::dot(d, patch.chart.frame.north)};
            visit(member, place, responseAt(patch, place));
        }
    }
}

std::vector<double> deflections(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<double> result(cloud.size(), 0.0);
    eachMoving(patch, cloud.positions(),
               [&](std::uint32_t point, const ChartPoint&, double response) { result[point] = force * response; });
    return result;
}

std::vector<glm::dvec3> displaced(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<glm::dvec3> result(cloud.positions().begin(), cloud.positions().end());
    eachMoving(patch, cloud.positions(), [&](std::uint32_t point, const ChartPoint&, double response) {
        result[point] += force * response * patch.forceDirection();
    });
    return result;
}

} // namespace palp
