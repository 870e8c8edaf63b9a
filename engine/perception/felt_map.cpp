#include "engine/perception/felt_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <string>

#include "engine/contact/contact.h"
#include "engine/core/contract.h"
#include "engine/core/parallel.h"
#include "engine/perception/perception.h"

namespace palp {
namespace {

/// Returns the first point in each cube of the lattice that holds points, and the first of the other side of a thin
/// object.
std::vector<std::uint32_t> onePerCube(const SoftObject& object, double edge)
{
    std::map<std::array<std::int64_t, 3>, std::vector<std::uint32_t>> taken;
    std::vector<std::uint32_t>                                        places;
    for (std::uint32_t n = 0; n < object.size(); ++n) {
        const glm::dvec3 p    = (object.positions()[n] - object.cloud().bounds().low) / edge;
        auto&            here = taken[{std::int64_t(p.x), std::int64_t(p.y), std::int64_t(p.z)}];
        if (!std::ranges::all_of(here, [&](std::uint32_t other) { return object.survey().apart(n, other); })) continue;
        here.push_back(n);
        places.push_back(n);
    }
    return places;
}

/// Returns the lattice's edge that leaves about the wanted number of places [m]: n places a spacing s apart become
/// n (s/edge)^2, and a surface that cuts cubes askew meets half as many again.
double edgeFor(const SoftObject& object, std::size_t wanted)
{
    constexpr double kAskew  = 1.5; // [1] Cauchy's formula for a lattice of cubes and a surface in all directions
    const double     spacing = object.spacing() > 0 ? object.spacing() : object.cloud().bounds().diagonal() / 100;
    return spacing * std::sqrt(std::max(1.0, kAskew * double(object.size()) / double(wanted)));
}

/// Returns the felt stiffness at all points from that at the places on their side of the object, unless none is near.
std::vector<double> between(const SoftObject& object, const FeltMap& map, double edge)
{
    constexpr std::size_t   kNearest = 8, kSides = 2; // the weight of a ninth would be negligible
    std::vector<glm::dvec3> places;
    for (const std::uint32_t place : map.places) places.push_back(object.positions()[place]);
    const NeighbourIndex index(places);
    std::vector<double>  felt;
    for (std::size_t point = 0; point < object.size(); ++point) {
        const auto there = [&](const Neighbour& n) { return object.survey().apart(point, map.places[n.point]); };
        auto       near  = index.nearest(object.positions()[point], kSides * kNearest);
        if (!std::ranges::all_of(near, there)) std::erase_if(near, there);
        near.resize(std::min(near.size(), kNearest));
        const double width = std::max(edge / 2, near.front().distance); // wide enough for a lone place
        double       sum = 0, weights = 0;
        for (const Neighbour& n : near) {
            const double weight = std::exp(-n.distance * n.distance / (2 * width * width));
            sum += weight * std::log(map.stiffness[n.point]);
            weights += weight;
        }
        felt.push_back(std::exp(sum / weights));
    }
    return felt;
}

/// Returns the felt stiffness of one touch [N/m].
double feltOf(const SoftObject& object, const Contact& contact, const PatchSettings& settings, PlateSolver& solver)
{
    const Patch patch = deform(object, contact, settings, solver);
    demandDeformed(patch);
    demandConverged(patch);
    return patch.feltStiffness;
}

/// Makes a map of what was felt at places; NaN was not.
FeltMap mapOf(const SoftObject& object, const std::vector<std::uint32_t>& places, const FeltTouches& felt, double edge)
{
    FeltMap map;
    map.leftOut  = felt.leftOut;
    map.takeover = felt.takeover;
    for (std::size_t n = 0; n < places.size(); ++n) {
        if (std::isnan(felt.stiffness[n])) continue;
        map.places.push_back(places[n]);
        map.stiffness.push_back(felt.stiffness[n]);
    }
    if (map.places.empty()) throw Error("map: no place of the object can be touched: " + felt.why);
    std::vector<double> sorted = map.stiffness;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
    map.typical  = sorted[sorted.size() / 2];
    map.atPoints = between(object, map, edge);
    return map;
}

} // namespace

FeltMap feltMap(const SoftObject& object, const PatchSettings& settings, std::size_t wanted, PlateSolver& solver,
                const std::function<void(std::size_t, std::size_t)>& onStep)
{
    PALP_EXPECT(wanted >= 8, std::to_string(wanted) + " places of a map");
    const double edge   = edgeFor(object, wanted);
    const auto   places = onePerCube(object, edge);
    FeltTouches  felt;
    for (std::size_t n = 0; n < places.size(); ++n) {
        if (onStep) onStep(n, places.size());
        felt.stiffness.push_back(std::numeric_limits<double>::quiet_NaN());
        try {
            const Contact contact = touchAt(object, object.positions()[places[n]], {}, edge);
            felt.stiffness.back() = feltOf(object, contact, settings, solver);
        } catch (const Error& error) { // a place at a rim or a tip: the others still give a map
            felt.why = error.what();
            ++felt.leftOut;
        }
    }
    return mapOf(object, places, felt, edge);
}

FeltMap feltMapEvery(const SoftObject& object, const PatchSettings& settings, double edge, std::string_view solver)
{
    constexpr double kFinest = 1e-6; // of the object [1]: points lie no closer, and cubes are counted in whole numbers
    if (!(std::isfinite(edge) && edge > 0))
        throw Error("map: expected a spacing above 0 m, found " + std::to_string(edge));
    const double cube   = std::max(edge, kFinest * object.cloud().bounds().diagonal());
    const auto   places = onePerCube(object, cube);
    const auto   at     = [&](std::size_t n) { return touchAt(object, object.positions()[places[n]], {}, cube); };
    return mapOf(object, places, feltTouches(object, settings, places.size(), at, solver), cube);
}

FeltTouches feltTouches(const SoftObject& object, const PatchSettings& settings, std::size_t count,
                        const std::function<Contact(std::size_t)>& contact, std::string_view solver)
{
    constexpr std::size_t kFewest = 8; // touches that are worth a solver and a thread
    FeltTouches           felt;
    std::mutex            mutex; // of all but the stiffness
    felt.stiffness.assign(count, std::numeric_limits<double>::quiet_NaN());
    prepareTouch(object, settings);
    inParallel(count, kFewest, [&](std::size_t begin, std::size_t end) {
        if (begin == end) return;
        PlateSolver own(solver);
        for (std::size_t n = begin; n < end; ++n) {
            try {
                felt.stiffness[n] = feltOf(object, contact(n), settings, own);
            } catch (const Error& error) { // a place at a rim or a tip
                const std::lock_guard lock(mutex);
                felt.why = error.what();
                ++felt.leftOut;
            }
        }
        const std::lock_guard lock(mutex);
        if (std::string who = own.takeoverSince(0); !who.empty()) felt.takeover = std::move(who);
    });
    return felt;
}

std::vector<double> detectability(const FeltMap& map, double weber)
{
    std::vector<double> share;
    for (const double felt : map.atPoints) share.push_back(rightAnswers(noticeableSteps(felt, map.typical, weber)));
    return share;
}

} // namespace palp
