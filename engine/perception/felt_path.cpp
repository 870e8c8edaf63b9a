#include "engine/perception/felt_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/force/governor.h"
#include "engine/perception/perception.h"
#include "engine/session/deformation.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/virtual_session.h"

namespace palp {
namespace {

/// Returns points of the surface along the line, from end to end.
std::vector<glm::dvec3> surfaceAlong(const FeltLine& line, const SoftObject& object, int places)
{
    constexpr double      kPace = 10e-3; // [m/s] any speed that is possible for a hand
    std::vector<HandPose> flat;
    for (int n = 0; n < places; ++n) {
        const double along = line.reach * (2.0 * n / (places - 1) - 1);
        flat.push_back({(along + line.reach) / kPace, line.middle.point + along * line.direction});
    }
    const HandPath          path = draped(HandPath(std::move(flat), "line"), line.middle, object);
    std::vector<glm::dvec3> points;
    for (const HandPose& waypoint : path.waypoints()) points.push_back(waypoint.position);
    return points;
}

double alongOf(const FeltLine& line, const glm::dvec3& place)
{
    return glm::dot(place - line.middle.point, line.direction);
}

/// Returns the outward direction at each place of a line: that of its middle, which turns with the surface from there
/// to either end. Where the surface turns too sharply to tell its side, the last one stays.
std::vector<glm::dvec3> outwardAlong(const FeltLine& line, const SoftObject& object, std::span<const glm::dvec3> places)
{
    constexpr double        kClear = 0.17; // cosine of 80 degrees [1]: beyond it deform() refuses a place
    std::vector<glm::dvec3> outward(places.size(), line.middle.outward);
    if (object.survey().spacings().empty()) return outward;
    const auto turned = [&](const glm::dvec3& place, const glm::dvec3& last) {
        const glm::dvec3 normal = object.survey().normal(object.index().nearest(place, 1).front().point);
        const double     cosine = glm::dot(normal, last);
        return std::abs(cosine) < kClear ? last : std::copysign(1.0, cosine) * normal;
    };
    const auto nearer = [&](const glm::dvec3& a, const glm::dvec3& b) {
        return std::abs(alongOf(line, a)) < std::abs(alongOf(line, b));
    };
    const auto middle = std::size_t(std::min_element(places.begin(), places.end(), nearer) - places.begin());
    outward[middle]   = turned(places[middle], line.middle.outward);
    for (std::size_t n = middle + 1; n < places.size(); ++n) outward[n] = turned(places[n], outward[n - 1]);
    for (std::size_t n = middle; n > 0; --n) outward[n - 1] = turned(places[n - 1], outward[n]);
    return outward;
}

/// Returns a path to and fro along the line that follows the height of the surface.
HandPath strokingHand(const FeltLine& line, const HandScript& script, const SoftObject& object)
{
    const Frame           from  = Frame::about(line.middle.outward);
    const glm::dvec3      north = glm::cross(from.normal, line.direction);
    std::vector<HandPose> waypoints;
    const HandPath        flat = makeHand(script, line.middle);
    for (const HandPose& waypoint : flat.waypoints()) {
        const glm::dvec3 d = waypoint.position - line.middle.point;
        waypoints.push_back({waypoint.time, line.middle.point + glm::dot(d, from.east) * line.direction +
                                                glm::dot(d, from.north) * north +
                                                glm::dot(d, from.normal) * from.normal});
    }
    return draped(HandPath(std::move(waypoints), "stroke", flat.repeatsFrom()), line.middle, object);
}

FeltRange rangeOf(const std::vector<double>& along, const std::vector<double>& logarithms)
{
    std::vector<double> sorted = along;
    std::ranges::sort(sorted);
    const bool isNear =
        std::ranges::adjacent_find(sorted, [](double a, double b) { return b - a <= kPassing; }) != sorted.end();
    return {largestRange(along, logarithms, std::numeric_limits<double>::infinity()),
            isNear ? largestRange(along, logarithms, kPassing) : std::numeric_limits<double>::quiet_NaN()};
}

} // namespace

FeltLine feltLine(const Scene& scene, const SoftObject& object, const std::optional<glm::dvec3>& direction,
                  double reach)
{
    constexpr double kSteep = 0.1; // share of a unit vector that lies in the surface [1]: 84 degrees from it
    const HandPlace  middle = handPlace(scene, object);
    if (!direction) return {middle, Frame::about(middle.outward).east, reach};
    const double length = glm::length(*direction);
    if (!(length > 0 && std::isfinite(length))) throw Error("the path's direction: expected a vector, found zero");
    const glm::dvec3 wanted = *direction / length;
    const glm::dvec3 inside = wanted - glm::dot(wanted, middle.outward) * middle.outward;
    if (glm::length(inside) < kSteep)
        throw Error("the path's direction: expected one along the surface, found one that leaves it; try x, y or z "
                    "across the side that the hand comes from");
    return {middle, glm::normalize(inside), reach};
}

std::vector<FeltPlace> windowsAlong(const SoftObject& object, const PatchSettings& settings, const FeltLine& line,
                                    int places, PlateSolver& solver)
{
    PALP_EXPECT(places >= 2, std::to_string(places) + " places of a line");
    std::optional<Frame>          carried;
    std::vector<FeltPlace>        result;
    const std::vector<glm::dvec3> path    = surfaceAlong(line, object, places);
    const std::vector<glm::dvec3> outward = outwardAlong(line, object, path);
    for (std::size_t n = 0; n < path.size(); ++n) {
        // As in a session, the normal that is felt stands in for that of a window about a rim.
        const Contact contact{.point = path[n], .outward = outward[n], .felt = true};
        const Patch   patch = deform(object, contact, settings, solver, carried);
        demandDeformed(patch, "try a smaller reach");
        demandConverged(patch);
        carried = patch.chart.frame;
        result.push_back({alongOf(line, path[n]), path[n], patch.contactStiffness, patch.compliance});
    }
    return result;
}

FeltStroke strokeAlong(const SoftObject& object, const Scene& scene, const FeltLine& line)
{
    constexpr double kSpeed   = 50e-3; // [m/s] a hand that explores
    constexpr double kHeight  = 5e-3;  // [m] where it starts
    constexpr double kDepth   = 0.4;   // of the thickness: a little more deflection is still within theory [1]
    constexpr double kHeld    = 5;     // of that depth: a wall or a fold keeps the proxy from following the hand [1]
    constexpr double kEngaged = 1.7;   // [s] after the first contact the force is fully on; the governor takes 1.5
    const double     down     = std::numbers::pi * (kHeight + kDepth * scene.material.thickness) / (2 * kSpeed);
    const double     cycle    = 2 * std::numbers::pi * line.reach / kSpeed;
    const HandScript script{.motion   = HandMotion::scan,
                            .speed    = kSpeed,
                            .depth    = kDepth * scene.material.thickness,
                            .radius   = line.reach,
                            .height   = kHeight,
                            .duration = down + kEngaged + cycle};

    const HandPath        hand = strokingHand(line, script, object);
    Deformation           deformation(object, scene);
    ScriptedHand          device(hand);
    std::vector<FeltTick> ticks;
    double                met = std::numeric_limits<double>::infinity(); // [s]
    runVirtual({scene, object, deformation.solver(), device, {}}, script.duration, [&](const TickRecord& s) {
        if (s.compliance > 0) met = std::min(met, s.time);
        const double depth = glm::length(s.proxy - s.hip), force = glm::length(s.force);
        const bool   limited = (s.actions & std::uint32_t(GovernorAction::clamped)) != 0;
        if (s.compliance > 0 && s.time >= met + kEngaged && depth > 0 && force > 0)
            ticks.push_back({alongOf(line, s.proxy), force / depth, limited || depth > kHeld * script.depth});
    });
    if (ticks.empty()) throw Error("the stroking hand met nothing along the path; try another place or reach");
    return {std::move(ticks), deformation.plateSolver().takeoverSince(0)};
}

double heldShare(const std::vector<FeltTick>& ticks)
{
    const auto held = std::count_if(ticks.begin(), ticks.end(), [](const FeltTick& tick) { return tick.held; });
    return ticks.empty() ? 0 : double(held) / double(ticks.size());
}

SoftObject homogeneous(const SoftObject& object)
{
    const auto          b = object.stiffening();
    std::vector<double> even(b.size());
    if (!b.empty()) std::ranges::fill(even, std::accumulate(b.begin(), b.end(), 0.0) / double(b.size()));
    return object.repainted(std::vector<double>(object.size(), geometricMean(object.cloud().stiffness())))
        .withFoundation({})
        .withStiffening(std::move(even));
}

FeltRange rangeOf(const std::vector<FeltPlace>& places, ForceLaw law)
{
    std::vector<double> along, logarithms;
    for (const FeltPlace& place : places) {
        along.push_back(place.along);
        logarithms.push_back(std::log(place.felt(law)));
    }
    return rangeOf(along, logarithms);
}

FeltRange rangeOf(const std::vector<FeltTick>& ticks)
{
    std::vector<double> along, logarithms;
    for (const FeltTick& tick : ticks) {
        if (tick.held) continue;
        along.push_back(tick.along);
        logarithms.push_back(std::log(tick.stiffness));
    }
    return rangeOf(along, logarithms);
}

} // namespace palp
