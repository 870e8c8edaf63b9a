#include "engine/body/two_faces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// Returns whether another face lies behind or before a point.
bool hasOtherFace(const SoftObject& object, std::size_t point, std::vector<std::uint32_t>& near,
                  std::vector<std::uint32_t>& points)
{
    constexpr std::size_t kEnough = 100'000;            // points
    constexpr double      kLeast = 0.4, kMost = 2.5;    // [thicknesses]
    constexpr double      kAside = 0.5, kAlong = 0.7;   // of the distance; cosine of 45 degrees [1]
    constexpr double      kSpacings = 1.2, kNoises = 6; // a surface's own points lie no farther off it [1]
    const SurfaceSurvey&  survey = object.survey();
    const double          h      = object.material().thickness;
    const double          least =
        std::max({kLeast * h, kSpacings * std::min(survey.spacing(point), h), kNoises * survey.noise(point)});
    const glm::dvec3 normal = survey.normal(point);
    if (!(glm::length(normal) > 0) || least > kMost * h) return false;
    if (!object.index().gatherRanks(object.positions()[point], std::hypot(1, kAside) * kMost * h, kEnough, near))
        return false; // so many lie within the thickness that this is no sheet, or takes too long to tell
    object.index().pointsOf(near, points);
    return std::ranges::any_of(points, [&](std::uint32_t other) {
        const glm::dvec3 d     = object.positions()[other] - object.positions()[point];
        const double     depth = std::abs(glm::dot(d, normal));
        if (depth < least || depth > kMost * h) return false;
        if (glm::length(d) > std::hypot(1, kAside) * depth) return false;
        const bool alike = survey.sided(point) && survey.sided(other) && glm::dot(survey.normal(other), normal) > 0;
        return !alike && std::abs(glm::dot(survey.normal(other), normal)) > kAlong;
    });
}

} // namespace

bool hasTwoFaces(const SoftObject& object)
{
    constexpr std::size_t      kAsked = 500; // points
    constexpr double           kShare = 0.1; // [1]
    const std::size_t          step   = object.size() / kAsked + 1;
    std::vector<std::uint32_t> near, points;
    double                     two = 0, all = 0;
    if (object.survey().spacings().empty()) return false;
    for (std::size_t point = 0; point < object.size(); point += step, ++all)
        two += hasOtherFace(object, point, near, points);
    return two > kShare * all;
}

} // namespace palp
