#include "engine/tools/study/hunt_score.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/session/scene_place.h"
#include "engine/session/servo.h"

namespace palp::study {
namespace {

/// Returns the points on which nodules may lie. They include the side that is turned away from the hand, because sides
/// are not distinguished.
std::vector<glm::dvec3> groundOf(const Scene& scene, const PointCloud& cloud)
{
    const HiddenNodules* const hidden = hiddenIn(scene);
    if (!hidden) throw Error("nothing is hidden in this scene: it has no \"hunt\"; see samples/scenes");
    const glm::dvec3        place = placeOf(scene, cloud);
    std::vector<glm::dvec3> ground;
    for (const glm::dvec3& p : cloud.positions())
        if (hidden->hunt.ground <= 0 || glm::distance(p, place) <= hidden->hunt.ground) ground.push_back(p);
    if (ground.empty())
        throw Error("hunt: key \"ground\": expected a radius about the scene's place that holds points of the object, "
                    "found none");
    return ground;
}

} // namespace

HuntScorer::HuntScorer(const Scene& scene, const PointCloud& cloud)
    : ground_(groundOf(scene, cloud)), index_(ground_), covered_(ground_.size())
{
    hunt_      = hiddenIn(scene)->hunt;
    footprint_ = scene.patch.footprintRadius;
    for (const Nodule& nodule : hiddenIn(scene)->nodules(cloud, scene)) score_.nodules.push_back({.nodule = nodule});
    edges_.resize(score_.nodules.size());
}

void HuntScorer::add(const TickRecord& record)
{
    constexpr double kLost = 0.1; // [s] a touch cannot be followed across a longer gap
    if (record.time < last_) begun_ += last_, last_ = -1, held_ = 0;
    const double dt  = last_ < 0 || record.time - last_ > kLost ? 0 : record.time - last_;
    last_            = record.time;
    const double now = begun_ + record.time, force = glm::length(record.force);
    const bool   touching = record.normal != glm::dvec3(0);
    score_.duration       = now;
    score_.peakForce      = std::max(score_.peakForce, force);
    score_.impulse += force * dt;
    press(record, now);
    if (touching) {
        score_.contact += dt;
        score_.meanForce += force * dt; // a sum until score()
        if (force > hunt_.tooHard) tooHard_ += dt;
        if (force >= hunt_.pressForce) {
            trace(record);
            cover(record.proxy);
        }
        draw(record);
    }
    touching_ = touching;
}

void HuntScorer::press(const TickRecord& record, double now)
{
    Hand hand;
    hand.setBits(record.device);
    const bool stopped = (record.faults & 0xFFU) != 0;
    if (hand.buttons == 0 || stopped || hand.device != DeviceFault::none) {
        held_ = 0;
        return;
    }
    if (held_++ == 0) {
        pressedAt_       = now;
        pressedOn_       = record.proxy;
        pressedTouching_ = record.normal != glm::dvec3(0);
    }
    if (held_ != ForceHalf::kPressTicks) return;
    if (pressedTouching_)
        declare(pressedAt_, pressedOn_);
    else
        ++score_.inAir;
}

void HuntScorer::declare(double time, const glm::dvec3& place)
{
    constexpr std::size_t kMost = 10'000; // declarations that are kept, more than a person makes
    const auto   gap = [&](const NoduleScore& n) { return glm::distance(place, n.nodule.centre) - n.nodule.radius; };
    const auto   nearest = std::ranges::min_element(score_.nodules, {}, gap);
    const double away    = glm::distance(place, nearest->nodule.centre);
    Declaration  one{.time = time, .place = place, .distance = away};
    if (gap(*nearest) <= footprint_) {
        one.nodule = int(nearest - score_.nodules.begin());
        one.again  = nearest->found;
        if (!one.again) {
            nearest->found = true, nearest->time = time, nearest->distance = away;
            ++score_.found;
        }
    } else {
        ++score_.falseAlarms;
    }
    if (score_.declarations.size() < kMost)
        score_.declarations.push_back(one);
    else
        ++score_.unkept;
}

void HuntScorer::trace(const TickRecord& record)
{
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const Nodule&    nodule = score_.nodules[i].nodule;
        const double     band   = std::max(nodule.radius / 4, footprint_ / 2);
        const glm::dvec3 from   = record.proxy - nodule.centre;
        if (glm::length(from) > nodule.radius + 2 * band) continue;
        Edge& edge = edges_[i];
        if (!edge.known) edge = {Frame::about(record.normal), 0, true}; // the normal changes little across a nodule
        const double east = glm::dot(from, edge.frame.east), north = glm::dot(from, edge.frame.north);
        if (std::abs(std::hypot(east, north) - nodule.radius) > band) continue;
        const double turn = std::atan2(north, east) / (2 * std::numbers::pi); // [1] -1/2 to 1/2
        const int    n    = int(std::floor((turn < 0 ? turn + 1 : turn) * kSectors));
        edge.traced |= std::uint64_t(1) << unsigned(std::clamp(n, 0, kSectors - 1));
    }
}

void HuntScorer::cover(const glm::dvec3& place)
{
    constexpr double kStep = 0.25; // share of the footprint's radius [1]; the ground between is covered from both sides
    if (coveredAny_ && glm::distance(place, coveredAt_) < kStep * footprint_) return;
    coveredAny_ = true;
    coveredAt_  = place;
    index_.gather(place, footprint_, near_);
    for (const std::uint32_t point : near_) covered_[point] = true;
}

void HuntScorer::draw(const TickRecord& record)
{
    constexpr double      kStep = 0.1;     // share of the footprint's radius, finer than a picture shows [1]
    constexpr std::size_t kMost = 200'000; // places; more would fill an area in a large file
    auto&                 path  = score_.path;
    if (!touching_ || path.empty()) path.emplace_back();
    if (!path.back().empty() && glm::distance(path.back().back(), record.proxy) < kStep * footprint_) return;
    if (drawn_++ < kMost) path.back().push_back(record.proxy);
}

HuntScore HuntScorer::score() const
{
    HuntScore    score = score_;
    const double total = score.contact;
    score.meanForce    = total > 0 ? score.meanForce / total : 0;
    score.tooHard      = total > 0 ? tooHard_ / total : 0;
    score.coverage     = double(std::ranges::count(covered_, true)) / double(covered_.size());
    score.mark         = 2 * double(score.found) / double(score.nodules.size() + score.found + score.falseAlarms);
    for (std::size_t i = 0; i < edges_.size(); ++i)
        score.nodules[i].edge = double(std::popcount(edges_[i].traced)) / kSectors;
    return score;
}

} // namespace palp::study
