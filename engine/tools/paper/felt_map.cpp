#include "engine/tools/paper/felt_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "engine/contact/contact.h"
#include "engine/core/contract.h"
#include "engine/tools/paper/perception.h"

namespace palp::report {
namespace {

/// Returns the first point in each cube of the lattice that holds points.
std::vector<std::uint32_t> onePerCube(const PointCloud& cloud, double edge)
{
    std::set<std::array<std::int64_t, 3>> taken;
    std::vector<std::uint32_t>            places;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        const glm::dvec3 p = (cloud.positions()[n] - cloud.bounds().low) / edge;
        if (taken.insert({std::int64_t(p.x), std::int64_t(p.y), std::int64_t(p.z)}).second)
            places.push_back(std::uint32_t(n));
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

/// Returns the felt stiffness at all points from that at the places.
std::vector<double> between(const PointCloud& cloud, const FeltMap& map, double edge)
{
    constexpr std::size_t   kNearest = 8; // the weight of a ninth would be negligible
    std::vector<glm::dvec3> places;
    for (const std::uint32_t place : map.places) places.push_back(cloud.positions()[place]);
    const NeighbourIndex index(places);
    std::vector<double>  felt;
    for (const glm::dvec3& p : cloud.positions()) {
        const auto   near  = index.nearest(p, kNearest);
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

} // namespace

FeltMap feltMap(const SoftObject& object, const PatchSettings& settings, std::size_t wanted, PlateSolver& solver,
                const std::function<void(std::size_t, std::size_t)>& onStep)
{
    PALP_EXPECT(wanted >= 8, std::to_string(wanted) + " places of a map");
    const double edge   = edgeFor(object, wanted);
    const auto   places = onePerCube(object.cloud(), edge);
    FeltMap      map;
    std::string  why;
    for (std::size_t n = 0; n < places.size(); ++n) {
        if (onStep) onStep(n, places.size());
        try {
            const Contact contact = touchAt(object, object.positions()[places[n]], {}, edge);
            const Patch   patch   = deform(object, contact, settings, solver);
            demandDeformed(patch);
            map.places.push_back(places[n]);
            map.stiffness.push_back(patch.feltStiffness);
        } catch (const Error& error) { // a place at a rim or a tip: the others still give a map
            why = error.what();
            ++map.leftOut;
        }
    }
    if (map.places.empty()) throw Error("map: no place of the object can be touched: " + why);
    std::vector<double> sorted = map.stiffness;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
    map.typical  = sorted[sorted.size() / 2];
    map.atPoints = between(object.cloud(), map, edge);
    return map;
}

std::vector<double> detectability(const FeltMap& map, double weber)
{
    std::vector<double> share;
    for (const double felt : map.atPoints) share.push_back(rightAnswers(noticeableSteps(felt, map.typical, weber)));
    return share;
}

} // namespace palp::report
