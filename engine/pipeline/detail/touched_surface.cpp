#include "engine/pipeline/detail/touched_surface.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/cloud/surface_flood.h"

namespace palp {
namespace {

constexpr double kUneven = 2; ///< the cloud's own spacing is taken up to this ratio of the two [1]

/// Radius about the contact within which the surface is smoothed to find the anchor [spacings]: 28 points.
constexpr double kNear = 3;

/// Radius of the same over the noise [1]: hundreds of points then take part.
constexpr double kNoisyNear = 18;

/// Radius about the contact whose normals give the mean one, over that of the ball [1].
constexpr double kFacing = 0.25;

constexpr double kTurned = 0.26, kFaces = 0.76; ///< cosines of 75 and 40 degrees [1]

/// Returns the mean of the normals near the contact.
glm::dvec3 meanNormal(const TouchedSurface& surface, const SoftObject& object, const glm::dvec3& centre, double radius)
{
    glm::dvec3 sum{};
    for (std::size_t k = 0; k < surface.points.size(); ++k) {
        const glm::dvec3 d     = object.positions()[surface.points[k]] - centre;
        const double     share = std::max(0.0, 1 - glm::dot(d, d) / (radius * radius));
        sum += share * share * surface.normals[k];
    }
    const double length = glm::length(sum);
    return length > 0 ? sum / length : glm::dvec3(0);
}

/// Moves the contact onto the surface of the points around it.
glm::dvec3 anchorOf(const TouchedSurface& surface, const SoftObject& object, const glm::dvec3& contact)
{
    const double            radius = std::max(kNear * surface.spacing, kNoisyNear * surface.noise);
    std::vector<glm::dvec3> near;
    for (const std::uint32_t point : surface.points)
        if (glm::length(object.positions()[point] - contact) <= radius) near.push_back(object.positions()[point]);
    const SphereFitResult fit = fitSphere(near);
    if (!fit.usable()) return contact;
    const glm::dvec3 foot = fit.fit.foot(contact);
    return glm::length(foot - contact) <= radius ? foot : contact;
}

} // namespace

double spacingAt(const SoftObject& object, const glm::dvec3& place)
{
    const double here = object.survey().spacing(object.index().nearest(place, 1).front().point);
    const double all  = object.spacing();
    return here > kUneven * all || all > kUneven * here ? here : all;
}

TouchedSurface touchedSurface(const SoftObject& object, const Contact& contact, double radius)
{
    SurfaceFlood   flood(object);
    TouchedSurface surface;
    const auto     points  = flood.reach(contact.point, radius, contact.outward);
    const auto     normals = flood.normals();
    surface.points.assign(points.begin(), points.end());
    surface.normals.assign(normals.begin(), normals.end());
    surface.spacing = spacingAt(object, contact.point);
    surface.noise   = points.empty() ? 0 : object.survey().noise(points.front());
    surface.anchor  = anchorOf(surface, object, contact.point);
    surface.normal  = meanNormal(surface, object, surface.anchor, kFacing * radius);
    return surface;
}

SphereFitResult fitSphereTo(const TouchedSurface& surface, const SoftObject& object, double radius)
{
    std::vector<glm::dvec3> points;
    std::vector<double>     weights;
    for (std::size_t k = 0; k < surface.points.size(); ++k) {
        const glm::dvec3 p     = object.positions()[surface.points[k]];
        const glm::dvec3 d     = p - surface.anchor;
        const double     share = std::max(0.0, 1 - glm::dot(d, d) / (radius * radius));
        const double     faces =
            std::clamp((glm::dot(surface.normals[k], surface.normal) - kTurned) / (kFaces - kTurned), 0.0, 1.0);
        if (share * faces == 0) continue;
        points.push_back(p);
        weights.push_back(share * share * faces);
    }
    return fitSphereThrough(surface.anchor, points, weights);
}

} // namespace palp
