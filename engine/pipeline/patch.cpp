#include "engine/pipeline/patch.h"

#include <cstdio>

namespace palp {

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
