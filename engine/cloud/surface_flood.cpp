#include "engine/cloud/surface_flood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace palp {

SurfaceFlood::SurfaceFlood(const SoftObject& object) : object_(object)
{
    object.survey().expectSurface();
}

/// Returns the point nearest to the middle, of those that do not face away from `outward`; the lowest index of equally
/// near ones. Only if all face away, the nearest of them.
std::optional<std::size_t> SurfaceFlood::start(const glm::dvec3& centre, const std::optional<glm::dvec3>& outward)
{
    const SurfaceSurvey&       survey = object_.survey();
    std::optional<std::size_t> nearest[2]; // that does not face away, and of all
    double                     least2[2] = {std::numeric_limits<double>::infinity(), least2[0]};
    for (std::size_t i = 0; i < inBall_.size(); ++i) {
        const glm::dvec3 d  = places_[i] - centre;
        const double     d2 = glm::dot(d, d);
        const bool away     = outward && survey.sided(inBall_[i]) && glm::dot(survey.normal(inBall_[i]), *outward) < 0;
        for (const int k : {0, 1}) {
            if (k == 0 && away) continue;
            if (d2 > least2[k] || (d2 == least2[k] && nearest[k] && inBall_[i] > inBall_[*nearest[k]])) continue;
            least2[k]  = d2;
            nearest[k] = i;
        }
    }
    // A facing point somewhere else in the ball is none here.
    const bool near = nearest[0] && least2[0] <= std::max(least2[1], steps_[*nearest[0]] * steps_[*nearest[0]]);
    return near ? nearest[0] : nearest[1];
}

/// Returns true if a step from a point that is reached leads to another one of the same sheet.
bool SurfaceFlood::connects(std::size_t from, std::size_t to, double distance2) const noexcept
{
    const double step = std::max(steps_[from], steps_[to]);
    if (distance2 > step * step) return false;
    const SurfaceSurvey& survey = object_.survey();
    const std::uint32_t  p = inBall_[from], q = inBall_[to];
    const glm::dvec3&    n = carried_[from];
    const glm::dvec3     m = survey.normal(q);
    if (glm::dot(m, m) == 0) return true;
    const bool turned = glm::dot(n, m) < 0;
    if (survey.sided(q) && inverted_ && turned != *inverted_) return false;
    const glm::dvec3 mean = turned ? n - m : n + m;
    const double     rise = std::abs(glm::dot(mean, places_[to] - places_[from])) / glm::length(mean);
    return rise <= kSteepest * std::sqrt(distance2) + kNoisy * std::max(survey.noise(p), survey.noise(q));
}

/// Remembers, at the first point whose side is known, whether the carried normals are the outward ones.
void SurfaceFlood::noteSide(std::size_t reached)
{
    const std::uint32_t point = inBall_[reached];
    if (!inverted_ && object_.survey().sided(point))
        inverted_ = glm::dot(carried_[reached], object_.survey().normal(point)) < 0;
}

std::span<const std::uint32_t> SurfaceFlood::reach(const glm::dvec3& centre, double radius,
                                                   const std::optional<glm::dvec3>& outward)
{
    object_.index().gather(centre, radius, gathered_);
    points_.clear();
    for (const std::uint32_t number : reachIn(gathered_, centre, outward)) points_.push_back(gathered_[number]);
    return points_;
}

std::span<const std::uint32_t> SurfaceFlood::reachIn(std::span<const std::uint32_t> ball, const glm::dvec3& centre,
                                                     const std::optional<glm::dvec3>& outward, double sparser)
{
    const SurfaceSurvey& survey = object_.survey();
    inBall_                     = ball;
    reached_.clear();
    normals_.clear();
    if (inBall_.empty()) return reached_;

    places_.clear();
    steps_.clear();
    double longest = 0; // [m] step
    for (const std::uint32_t point : inBall_) {
        places_.push_back(object_.positions()[point]);
        steps_.push_back(kStep * sparser * survey.spacing(point));
        longest = std::max(longest, steps_.back());
    }
    const std::size_t first = *start(centre, outward);
    carried_.assign(inBall_.size(), glm::dvec3(0));
    carried_[first] = survey.normal(inBall_[first]);
    if (outward && glm::dot(carried_[first], *outward) < 0) carried_[first] = -carried_[first];
    if (outward && carried_[first] == glm::dvec3(0)) carried_[first] = glm::normalize(*outward);
    grid_.build(places_, longest);
    inverted_.reset();
    noteSide(first);

    // A point that is reached is taken out of the grid, so that all searches together see each point only some times.
    reached_.assign(1, std::uint32_t(first));
    grid_.takeNear(places_[first], 0, [&](std::size_t i, double) { return i == first; });
    for (std::size_t next = 0; next < reached_.size(); ++next) {
        const std::uint32_t from = reached_[next];
        grid_.takeNear(places_[from], longest, [&](std::size_t i, double distance2) {
            if (!connects(from, i, distance2)) return false;
            const glm::dvec3 own = survey.normal(inBall_[i]);
            carried_[i] = glm::dot(own, own) == 0 ? carried_[from] : glm::dot(own, carried_[from]) < 0 ? -own : own;
            noteSide(i);
            reached_.push_back(std::uint32_t(i));
            return true;
        });
    }
    for (const std::uint32_t i : reached_) normals_.push_back(carried_[i]);
    return reached_;
}

} // namespace palp
