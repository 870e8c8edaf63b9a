#include "engine/cloud/surface_flood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "engine/cloud/surface_links.h"

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
    for (std::size_t i = 0; i < ranks_.size(); ++i) {
        const glm::dvec3 d  = places_[i] - centre;
        const double     d2 = glm::dot(d, d);
        const bool       away =
            outward && survey.sidedOfRank(ranks_[i]) && glm::dot(survey.normalOfRank(ranks_[i]), *outward) < 0;
        for (const int k : {0, 1}) {
            if (k == 0 && away) continue;
            if (d2 > least2[k] || (d2 == least2[k] && nearest[k] && ranks_[i] > ranks_[*nearest[k]])) continue;
            least2[k]  = d2;
            nearest[k] = i;
        }
    }
    // A facing point somewhere else in the ball is none here.
    const bool near = nearest[0] && least2[0] <= std::max(least2[1], steps_[*nearest[0]] * steps_[*nearest[0]]);
    return near ? nearest[0] : nearest[1];
}

/// Returns whether two points are near enough for a step.
bool SurfaceFlood::isNear(std::size_t from, std::size_t to, double distance2) const noexcept
{
    const double step = std::max(steps_[from], steps_[to]);
    return distance2 <= step * step;
}

/// Returns whether a step from a point that is reached runs along the sheet.
bool SurfaceFlood::runsAlong(std::size_t from, std::size_t to) const noexcept
{
    const SurfaceSurvey& survey = object_.survey();
    return runsAlongSheet(carried_[from], survey.normalOfRank(ranks_[to]), places_[to] - places_[from],
                          std::max(survey.noiseOfRank(ranks_[from]), survey.noiseOfRank(ranks_[to])));
}

/// Goes to a point from one that is reached, unless it is known to face the other way.
bool SurfaceFlood::take(std::size_t from, std::size_t to)
{
    const SurfaceSurvey& survey = object_.survey();
    const glm::dvec3     own    = survey.normalOfRank(ranks_[to]);
    const bool           turned = glm::dot(own, carried_[from]) < 0, none = glm::dot(own, own) == 0;
    if (!none && survey.sidedOfRank(ranks_[to]) && inverted_ && turned != *inverted_) return false;
    carried_[to] = none ? carried_[from] : turned ? -own : own;
    noteSide(to);
    reached_.push_back(std::uint32_t(to));
    return true;
}

/// Remembers, at the first point whose side is known, whether the carried normals are the outward ones.
void SurfaceFlood::noteSide(std::size_t reached)
{
    const std::uint32_t rank = ranks_[reached];
    if (!inverted_ && object_.survey().sidedOfRank(rank))
        inverted_ = glm::dot(carried_[reached], object_.survey().normalOfRank(rank)) < 0;
}

/// Floods along the steps that are known of the object.
void SurfaceFlood::floodByLinks()
{
    // Of all points of the object: 0 outside of the ball, else twice its number there and 2, and 1 more once it is
    // reached.
    static thread_local std::vector<std::uint32_t> slots;
    if (slots.size() < object_.size()) slots.resize(object_.size(), 0);
    struct Emptied { // also where an exception ends the flood
        std::span<const std::uint32_t> ranks;
        ~Emptied()
        {
            for (const std::uint32_t rank : ranks) slots[rank] = 0;
        }
    } const emptied{ranks_};
    for (std::size_t i = 0; i < ranks_.size(); ++i) slots[ranks_[i]] = std::uint32_t(2 * i + 2);

    SurfaceLinks& links = object_.links();
    links.prepare(ranks_);
    const auto numberOf = [](std::uint32_t slot) { return std::size_t(slot / 2 - 1); };
    const auto leads    = [&](std::size_t from, std::size_t to) {
        const bool any =
            carried_[from] != glm::dvec3(0) && object_.survey().normalOfRank(ranks_[from]) == glm::dvec3(0);
        if (any && !runsAlong(from, to)) return false; // its links do not say so
        if (!take(from, to)) return false;
        slots[ranks_[to]] |= 1;
        return true;
    };
    slots[ranks_[reached_.front()]] |= 1;
    // A point takes the sign that most of the points before it ask for, unless its side is known: about an edge, or on
    // the wall of a thin body, the one that came first may have a normal that says little.
    std::vector<bool> settled(ranks_.size());
    const auto        settle = [&](std::uint32_t i) {
        double sum = 0;
        for (const std::uint32_t rank : links.from(ranks_[i]))
            if (const std::uint32_t slot = slots[rank]; slot % 2 != 0 && settled[numberOf(slot)])
                sum += glm::dot(carried_[numberOf(slot)], carried_[i]);
        if (sum < 0 && !(inverted_ && object_.survey().sidedOfRank(ranks_[i]))) carried_[i] = -carried_[i];
        settled[i] = true;
    };
    std::size_t next  = 0;
    const auto  flood = [&] {
        for (; next < reached_.size(); ++next) {
            const std::uint32_t from = reached_[next];
            settle(from);
            for (const std::uint32_t rank : links.from(ranks_[from]))
                if (const std::uint32_t slot = slots[rank]; slot != 0 && slot % 2 == 0)
                    (void)leads(from, numberOf(slot));
        }
    };
    // Some steps are known at their far end alone.
    for (std::size_t before = 0; before != reached_.size();) {
        flood();
        before = reached_.size();
        for (std::size_t i = 0; i < ranks_.size(); ++i) {
            if (slots[ranks_[i]] % 2 != 0) continue;
            const auto near = links.from(ranks_[i]);
            (void)std::ranges::any_of(near, [&](std::uint32_t rank) {
                return slots[rank] % 2 != 0 && runsAlong(numberOf(slots[rank]), i) && leads(numberOf(slots[rank]), i);
            });
        }
    }
}

/// Floods by searches among the points of the ball.
void SurfaceFlood::floodByGrid(double longest)
{
    // A point that is reached is taken out of the grid, so that all searches together see each point only some times.
    grid_.build(places_, longest);
    grid_.takeNear(places_[reached_.front()], 0, [&](std::size_t i, double) { return i == reached_.front(); });
    for (std::size_t next = 0; next < reached_.size(); ++next) {
        const std::uint32_t from = reached_[next];
        grid_.takeNear(places_[from], longest, [&](std::size_t i, double distance2) {
            return isNear(from, i, distance2) && runsAlong(from, i) && take(from, i);
        });
    }
}

std::span<const std::uint32_t> SurfaceFlood::reach(const glm::dvec3& centre, double radius,
                                                   const std::optional<glm::dvec3>& outward)
{
    object_.index().gatherRanks(centre, radius, gathered_);
    found_.clear();
    for (const std::uint32_t number : reachIn(gathered_, centre, outward)) found_.push_back(gathered_[number]);
    object_.index().pointsOf(found_, points_);
    return points_;
}

std::span<const std::uint32_t> SurfaceFlood::reachIn(std::span<const std::uint32_t> ranks, const glm::dvec3& centre,
                                                     const std::optional<glm::dvec3>& outward, double sparser)
{
    const SurfaceSurvey& survey = object_.survey();
    ranks_                      = ranks;
    reached_.clear();
    normals_.clear();
    if (ranks_.empty()) return reached_;

    places_.clear();
    steps_.clear();
    double longest = 0; // [m] step
    for (const std::uint32_t rank : ranks_) {
        places_.push_back(object_.index().positionsByRank()[rank]);
        steps_.push_back(kLongestStep * sparser * survey.spacingOfRank(rank));
        longest = std::max(longest, steps_.back());
    }
    const std::size_t first = *start(centre, outward);
    carried_.assign(ranks_.size(), glm::dvec3(0));
    carried_[first] = survey.normalOfRank(ranks_[first]);
    if (outward && glm::dot(carried_[first], *outward) < 0) carried_[first] = -carried_[first];
    if (outward && carried_[first] == glm::dvec3(0)) carried_[first] = glm::normalize(*outward);
    inverted_.reset();
    noteSide(first);
    reached_.assign(1, std::uint32_t(first));
    if (sparser == 1)
        floodByLinks();
    else
        floodByGrid(longest);
    for (const std::uint32_t i : reached_) normals_.push_back(carried_[i]);
    return reached_;
}

} // namespace palp
