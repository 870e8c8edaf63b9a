#include "engine/session/session_parts.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace palp {

DeviceFrame deviceFrame(const glm::dvec3& origin, const glm::dvec3& outward)
{
    constexpr double kAlong = 0.9; // of cos: the scene's x is then too near to the normal to give a direction [1]
    const glm::dvec3 up     = glm::normalize(outward);
    const glm::dvec3 axis   = std::abs(up.x) < kAlong ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right  = glm::normalize(axis - glm::dot(axis, up) * up);
    return {origin, glm::quat_cast(glm::dmat3(right, up, glm::cross(right, up)))};
}

} // namespace palp
