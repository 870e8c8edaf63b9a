#include "engine/tools/gui/pick.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace palp {

Ray rayThrough(const Camera& camera, const glm::dvec2& at, const glm::dvec2& size)
{
    const double     half = camera.halfHeight();                                        // [m] at the target
    const glm::dvec2 share(2 * at.x / size.y - size.x / size.y, 1 - 2 * at.y / size.y); // of half the height
    const glm::dvec3 there = camera.middle() + half * (share.x * camera.right() + share.y * camera.upwards());
    const glm::dvec3 eye   = camera.eye();
    if (camera.projection == Projection::perspective) return {eye, glm::normalize(there - eye)};
    return {there + camera.distance * camera.toEye, -camera.toEye};
}

std::optional<Hit> pick(const Ray& ray, std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
                        std::span<const double> radii, double blur)
{
    constexpr double kBehind = 0.35; // of the blur: points farther from the first disc's plane are another sheet [1]
    const auto       farOff  = [&](const glm::dvec3& point) { // square of the distance from the ray [m²]
        const glm::dvec3 away  = point - ray.from;
        const double     along = glm::dot(away, ray.along);
        return along > 0 ? glm::dot(away, away) - along * along : std::numeric_limits<double>::infinity();
    };
    double      nearest = std::numeric_limits<double>::infinity(); // along the ray [m]
    std::size_t first   = positions.size();
    for (std::size_t n = 0; n < positions.size(); ++n) {
        if (farOff(positions[n]) > radii[n] * radii[n]) continue;
        const double along = glm::dot(positions[n] - ray.from, ray.along);
        if (along >= nearest) continue;
        nearest = along;
        first   = n;
    }
    if (first == positions.size()) return std::nullopt;

    const double     reach  = std::max(blur, radii[first]);
    const glm::dvec3 facing = glm::dot(normals[first], ray.along) > 0 ? -normals[first] : normals[first];
    glm::dvec3       middle(0), outward(0);
    double           sum = 0;
    for (std::size_t n = 0; n < positions.size(); ++n) {
        const double square = farOff(positions[n]);
        if (!(square < reach * reach)) continue;
        if (std::abs(glm::dot(positions[n] - positions[first], facing)) > kBehind * reach && n != first) continue;
        const double share  = 1 - square / (reach * reach);
        const double weight = share * share;
        middle += weight * positions[n];
        outward += weight * (glm::dot(normals[n], facing) < 0 ? -normals[n] : normals[n]);
        sum += weight;
    }
    if (!(sum > 0) || !(glm::length(outward) > 0)) return Hit{positions[first], facing};
    middle /= sum;
    outward = glm::normalize(outward);
    // The hit is where the ray goes through the plane of the means.
    const double slope = glm::dot(ray.along, outward);
    if (std::abs(slope) < 0.1) return Hit{middle, outward};
    return Hit{ray.from + glm::dot(middle - ray.from, outward) / slope * ray.along, outward};
}

} // namespace palp
