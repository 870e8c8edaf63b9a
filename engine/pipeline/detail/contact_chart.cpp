#include "engine/pipeline/detail/contact_chart.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/pipeline/detail/stage_clock.h"

namespace palp {
namespace {

/// Takes the plane that the proxy felt where the fit is none or disagrees by more than 60 degrees, as at a rim.
void takeFeltNormal(Patch& patch, const TouchedSurface& surface)
{
    constexpr double kAgrees = 0.5; // cosine of 60 degrees [1]
    const Contact&   contact = patch.contact;
    const bool       agrees  = patch.sphere.usable() &&
                        std::abs(glm::dot(patch.sphere.fit.normal(surface.anchor), contact.outward)) >= kAgrees;
    if (!contact.felt || agrees) return;
    patch.normalFelt           = true;
    patch.sphere.outcome       = FitOutcome::plane;
    patch.sphere.fit           = {};
    patch.sphere.fit.reference = contact.point;
    patch.sphere.fit.gradient  = contact.outward;
}

std::string degrees(double cosine)
{
    return std::to_string(std::lround(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi)) + " degrees";
}

/// Returns true if the cloud has another side behind the contact: points in a tube inwards, beyond the surface itself.
bool isClosedBehind(const SoftObject& object, const glm::dvec3& contact, const glm::dvec3& outward)
{
    const double reach = 3 * object.spacing(); // radius of the tube, and where it begins: some ten points across [m]
    const double end   = object.cloud().bounds().diagonal();
    const auto   holds = [&](std::uint32_t point) {
        const glm::dvec3& p     = object.positions()[point];
        const double      depth = glm::dot(contact - p, outward);
        return depth > reach && glm::length(p + depth * outward - contact) < reach;
    };
    constexpr double kWorth = 20; // points that cost what a ball does [1]; a stray point afar makes a tube of millions
    if (end / (2 * reach) > double(object.size()) / kWorth) {
        for (std::uint32_t point = 0; point < object.size(); ++point)
            if (holds(point)) return true;
        return false;
    }
    std::vector<std::uint32_t> near; // balls about the middles of the tube's pieces, each as long as wide
    for (double depth = 2 * reach; depth < end + 2 * reach; depth += 2 * reach) {
        object.index().gather(contact - depth * outward, std::sqrt(2.0) * reach, near);
        if (std::any_of(near.begin(), near.end(), holds)) return true;
    }
    return false;
}

} // namespace

void fitSphereTo(Patch& patch, const SoftObject& object, const Ball& ball, const TouchedSurface& surface,
                 const PatchSettings& settings)
{
    const StageClock clock(patch.times.fit);
    if (settings.neighbourhood == Neighbourhood::surface) {
        patch.sphere = surface.sphere;
        takeFeltNormal(patch, surface);
        return;
    }
    std::vector<glm::dvec3> points;
    points.reserve(ball.points.size());
    for (const std::uint32_t point : ball.points) points.push_back(object.positions()[point]);
    patch.sphere = fitSphere(points);
}

Chart chartAt(Patch& patch, const SoftObject& object, Map map, const std::optional<Frame>& carried)
{
    constexpr double kSteep = 0.17, kClear = 0.5; // cosines of 80 and 60 degrees [1]
    const Contact    contact = patch.contact;
    const auto       around  = [&](const glm::dvec3& side) {
        return Chart::around(patch.sphere.fit, contact.point, side, map, carried);
    };
    const Chart  chart  = around(contact.outward);
    const auto&  normal = chart.frame.normal;
    const double cosine = glm::dot(normal, contact.outward);
    if (contact.outwardKnown && cosine < kSteep)
        throw Error(placeText(patch.contact) + ": the direction from which the finger comes is " + degrees(cosine) +
                    " from the surface's normal (" + directionText(normal) +
                    "), expected at most 80, or the side is not clear; try that normal or its opposite");
    if (contact.outwardKnown) return chart;
    patch.sideUnsure = !isClosedBehind(object, contact.point, normal);
    if (!patch.sideUnsure || cosine >= kClear) return chart;
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    patch.contact.outward = {axis == 0, axis == 1, axis == 2};
    return around(patch.contact.outward);
}

} // namespace palp
