#include "engine/pipeline/patch.h"

#include <cstdio>

#include "engine/core/contract.h"

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

std::vector<double> deflections(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<double> result(cloud.size(), 0.0);
    for (std::size_t n = 0; n < patch.points.size(); ++n) result[patch.points[n]] = force * patch.pointResponse[n];
    return result;
}

std::vector<glm::dvec3> displaced(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<glm::dvec3> result(cloud.positions().begin(), cloud.positions().end());
    for (std::size_t n = 0; n < patch.points.size(); ++n)
        result[patch.points[n]] += force * patch.pointResponse[n] * patch.forceDirection();
    return result;
}

} // namespace palp
