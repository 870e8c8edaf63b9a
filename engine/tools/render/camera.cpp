#include "engine/tools/render/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

/// Rotates by Rodrigues' formula.
/// \param axis   unit vector
/// \param angle  [rad]
glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double angle)
{
    return std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v) +
           (1 - std::cos(angle)) * glm::dot(axis, v) * axis;
}

} // namespace

glm::dvec3 Camera::right() const
{
    return glm::normalize(glm::cross(up, toEye));
}

glm::dvec3 Camera::upwards() const
{
    return glm::cross(toEye, right());
}

glm::dvec3 Camera::middle() const
{
    return target - halfHeight() * (centre.x * right() + centre.y * upwards());
}

glm::dvec3 Camera::eye() const
{
    return middle() + distance * toEye;
}

double Camera::halfHeight() const
{
    return distance * std::tan(kFieldOfView / 2);
}

Camera orbited(const Camera& camera, const glm::dvec2& angles)
{
    constexpr double kPole  = 0.02; // least angle between the eye and a pole [rad]
    Camera           result = camera;
    result.toEye            = turned(camera.toEye, camera.up, -angles.x);
    const double height     = std::asin(std::clamp(glm::dot(camera.up, camera.toEye), -1.0, 1.0)); // [rad]
    const double most       = glm::half_pi<double>() - kPole;
    const double wanted     = std::clamp(height + angles.y, -most, most);
    result.toEye            = glm::normalize(turned(result.toEye, result.right(), height - wanted));
    return result;
}

Camera panned(const Camera& camera, const glm::dvec2& share)
{
    Camera result = camera;
    result.target -= camera.halfHeight() * (share.x * camera.right() + share.y * camera.upwards());
    return result;
}

Camera dollied(const Camera& camera, double factor)
{
    PALP_EXPECT(factor > 0, "a camera's distance is multiplied by a number above 0");
    Camera result = camera;
    result.distance *= factor;
    return result;
}

Camera framed(const Camera& camera, const glm::dvec3& centre, double radius, double aspect)
{
    PALP_EXPECT(radius > 0 && aspect > 0, "a camera frames a ball of a positive radius in a picture of positive sides");
    constexpr double kRoom  = 1.08; // around the ball [1]
    Camera           result = camera;
    result.target           = centre;
    // The ball touches the cone of sight: sin of half the narrower angle is radius over distance.
    const double narrow = std::atan(std::tan(kFieldOfView / 2) * std::min(1.0, aspect));
    result.distance     = kRoom * radius / std::sin(narrow);
    return result;
}

Camera otherProjection(const Camera& camera)
{
    Camera result = camera;
    result.projection =
        camera.projection == Projection::perspective ? Projection::orthographic : Projection::perspective;
    return result;
}

CameraMatrices matricesOf(const Camera& camera, const glm::dvec3& origin, double reach, double aspect)
{
    constexpr double kNearest = 0.02; // of the distance: nearer than that nothing is drawn in perspective [1]
    const glm::dvec3 right = camera.right(), up = camera.upwards();
    const glm::dvec3 eye = camera.eye() - origin;
    CameraMatrices   result;
    for (int k = 0; k < 3; ++k) {
        result.viewFromWorld[k] = {right[k], up[k], camera.toEye[k], 0};
    }
    result.viewFromWorld[3] = {-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(camera.toEye, eye), 1};

    // Depth d becomes (a d + b) / w: 0 at the near plane, 1 at the far one.
    const bool   perspective = camera.projection == Projection::perspective;
    const double least =
        perspective ? std::max(kNearest * camera.distance, camera.distance - reach) : camera.distance - reach;
    const double most = camera.distance + reach;
    const double half = perspective ? std::tan(kFieldOfView / 2) : camera.halfHeight();
    result.halfAtOne  = {half * aspect, half};
    glm::dmat4& clip  = result.clipFromView;
    clip              = glm::dmat4(0);
    clip[0][0]        = 1 / (half * aspect);
    clip[1][1]        = -1 / half;
    if (perspective) {
        clip[2][2] = -most / (most - least);
        clip[3][2] = -most * least / (most - least);
        clip[2][3] = -1;
    } else {
        clip[2][2] = -1 / (most - least);
        clip[3][2] = -least / (most - least);
        clip[3][3] = 1;
    }
    return result;
}

} // namespace palp
