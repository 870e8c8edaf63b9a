#include "engine/tools/bench/point_bench.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

#include "engine/chart/nearest_map.h"
#include "engine/cloud/neighbour_index.h"
#include "engine/cloud/samples.h"
#include "engine/pipeline/deform.h"
#include "engine/plate/load.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/tools/bench/accuracy.h"
#include "engine/tools/bench/outside_peers.h"
#include "engine/tools/bench/point_scenes.h"

namespace palp::bench {
namespace {

/// Leaf sizes of nanoflann. The fastest one depends on the work: its time is the best of these.
constexpr std::array<std::size_t, 3> kLeaves{10, 20, 50};

Quartiles scaled(const Quartiles& q, double by)
{
    return {q.lower * by, q.median * by, q.upper * by};
}

// --- gather

/// Returns the share of points that are missing or too many, against brute force in doubles [1].
double wrongShare(const std::vector<glm::dvec3>& cloud, const glm::dvec3& centre, double radius,
                  std::set<std::uint32_t> found)
{
    std::size_t wrong = 0, right = 0;
    for (std::uint32_t p = 0; p < cloud.size(); ++p) {
        const glm::dvec3 d = cloud[p] - centre;
        if (glm::dot(d, d) > radius * radius) continue;
        ++right;
        if (!found.erase(p)) ++wrong;
    }
    return double(wrong + found.size()) / double(std::max<std::size_t>(right, 1));
}

std::vector<BenchRow> measureGather(int runs)
{
    constexpr std::size_t kPoints = 400'000, kPlaces = 64, kChecked = 8;
    const auto            cloud = bumpyBall(kPoints);
    const NeighbourIndex  index(cloud);
    const auto            places = searchPlaces(cloud, index.spacing(), kPlaces);
    const auto&           peers  = outsidePeers();

    std::vector<std::unique_ptr<RadiusSearch>> trees;
    if (peers.radiusSearch)
        for (const std::size_t leaf : kLeaves) trees.push_back(peers.radiusSearch(cloud, leaf));

    std::vector<BenchRow> rows;
    for (const int neighbours : {30, 300, 3000}) {
        const double               radius = index.spacing() * std::sqrt(neighbours / std::numbers::pi);
        std::vector<std::uint32_t> found;
        std::vector<std::pair<std::uint32_t, float>> pairs;
        std::vector<Contestant>                      contestants;
        for (const auto& tree : trees)
            contestants.push_back({"nanoflann", {[&] {
                                       for (const glm::dvec3& place : places) tree->gather(place, radius, pairs);
                                   }}});
        contestants.push_back({"Palpate", {[&] {
                                   for (const glm::dvec3& place : places) index.gather(place, radius, found);
                               }}});
        const auto timings = takeTurns(contestants, runs);

        BenchRow row;
        row.kind       = "gather";
        row.accuracy   = "exact";
        row.peer       = "nanoflann";
        row.points     = double(kPoints);
        row.neighbours = neighbours;
        row.palpateMs  = scaled(timings.back().total, 1.0 / kPlaces);
        row.error      = 0;
        for (std::size_t c = 0; c < kChecked; ++c) {
            index.gather(places[c], radius, found);
            row.error = std::max(*row.error, wrongShare(cloud, places[c], radius, {found.begin(), found.end()}));
        }
        if (trees.empty()) {
            row.note = peers.nanoflannNote;
        } else {
            const auto best =
                std::min_element(timings.begin(), timings.end() - 1,
                                 [](const Timing& a, const Timing& b) { return a.total.median < b.total.median; });
            row.peerMs    = scaled(best->total, 1.0 / kPlaces);
            row.note      = "leaf " + std::to_string(kLeaves[std::size_t(best - timings.begin())]);
            row.peerError = 0;
            for (std::size_t c = 0; c < kChecked; ++c) {
                trees.front()->gather(places[c], radius, pairs);
                std::set<std::uint32_t> theirs;
                for (const auto& [point, distance2] : pairs) theirs.insert(point);
                row.peerError = std::max(*row.peerError, wrongShare(cloud, places[c], radius, std::move(theirs)));
            }
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

// --- the nearest point of every node

/// Returns the share of some nodes whose point is farther away than the nearest one [1].
double wrongShare(const GridMapScene& scene, const std::vector<std::uint32_t>& nearest)
{
    constexpr int kChecked = 500;
    int           wrong    = 0;
    for (int n = 0; n < kChecked; ++n) {
        const int        i = int(std::size_t(n) * 7919 % std::size_t(scene.grid.nodesX()));
        const int        j = int(std::size_t(n) * 104729 % std::size_t(scene.grid.nodesZ()));
        const ChartPoint at{scene.origin.x + i * scene.grid.spacingX, scene.origin.z + j * scene.grid.spacingZ};
        const auto       distance2 = [&](const ChartPoint& p) {
            return (p.x - at.x) * (p.x - at.x) + (p.z - at.z) * (p.z - at.z);
        };
        double least = std::numeric_limits<double>::infinity();
        for (const ChartPoint& p : scene.points) least = std::min(least, distance2(p));
        wrong += distance2(scene.points[nearest[std::size_t(i * scene.grid.nodesZ() + j)]]) > least;
    }
    return double(wrong) / kChecked;
}

BenchRow measureGridMap(int nodes, int runs)
{
    const GridMapScene         scene(nodes, 1);
    const auto&                peers = outsidePeers();
    std::vector<std::uint32_t> ours, theirs;
    std::vector<Contestant>    contestants;
    if (peers.nearestMap)
        for (const std::size_t leaf : kLeaves)
            contestants.push_back({"nanoflann", {[&, leaf] {
                                       theirs = peers.nearestMap(scene.grid, scene.origin, scene.points, leaf);
                                   }}});
    contestants.push_back({"Palpate", {[&] { ours = nearestPoint(scene.grid, scene.origin, scene.points); }}});
    const auto timings = takeTurns(contestants, runs);

    BenchRow row;
    row.kind      = "grid_map";
    row.accuracy  = "exact";
    row.peer      = "nanoflann";
    row.nodes     = nodes;
    row.points    = double(scene.points.size());
    row.palpateMs = timings.back().total;
    row.error     = wrongShare(scene, ours);
    if (!peers.nearestMap) {
        row.note = peers.nanoflannNote;
        return row;
    }
    const auto best = std::min_element(timings.begin(), timings.end() - 1, [](const Timing& a, const Timing& b) {
        return a.total.median < b.total.median;
    });
    row.peerMs      = best->total;
    row.peerError   = wrongShare(scene, theirs);
    row.note        = "leaf " + std::to_string(kLeaves[std::size_t(best - timings.begin())]);
    return row;
}

// --- a whole update

/// Returns the touch's settings with a window that gathers some `wanted` points.
PatchSettings gathering(double wanted, PatchSettings settings, const SoftObject& object, const Contact& contact,
                        PlateSolver& solver)
{
    for (int n = 0; n < 4; ++n) { // the number of points grows with the square of the window
        const Patch patch = deform(object, contact, settings, solver);
        settings.window *= std::sqrt(wanted / double(patch.gathered.size()));
        settings.footprintRadius = std::min(settings.footprintRadius, settings.window / 4);
    }
    return settings;
}

/// Names the stages of an update and gives each one's median.
void addParts(BenchRow& row, const std::vector<StageTimes>& times)
{
    const auto stage = [&](const char* name, double StageTimes::*member) {
        std::vector<double> values;
        for (const StageTimes& t : times) values.push_back(t.*member);
        row.partNames.emplace_back(name);
        row.palpatePartsMs.push_back(quartiles(values).median);
    };
    stage("gather", &StageTimes::gather);
    stage("fit", &StageTimes::fit);
    stage("project", &StageTimes::project);
    stage("resample", &StageTimes::resample);
    stage("prepare", &StageTimes::prepare);
    stage("solve", &StageTimes::solve);
    stage("lift", &StageTimes::lift);
}

/// Measures an update on the paper's object: an ellipsoid of 40 000 points, and a patch window that gathers some 3000
/// of them.
/// \param tolerance  of the solver; "coarse" in the table, unless it is the default one
BenchRow measureUpdate(int nodes, double tolerance, int runs, PlateSolver& solver)
{
    constexpr std::size_t kPoints   = 40'000;
    constexpr double      kGathered = 3000;
    const Sample&         sample    = sampleNamed("ellipsoid");
    const SoftObject      object(makeSample(sample, kPoints, 1), sample.material);
    const Contact         contact = touchAt(object, sample.place, sample.from, object.spacing() * 10);
    PatchSettings         settings;
    settings.foundation      = sample.foundation;
    settings.window          = sample.window;
    settings.footprintRadius = sample.footprintRadius;
    settings.cells           = nodes - 1;
    settings.tolerance       = tolerance;
    settings                 = gathering(kGathered, settings, object, contact, solver);

    Patch                   patch;
    std::vector<StageTimes> times;
    const auto              timing = takeTurns({{"Palpate",
                                                 {[&] {
                                        patch = deform(object, contact, settings, solver);
                                        times.push_back(patch.times);
                                    }},
                                                 clockOf(solver)}},
                                               runs);
    times.erase(times.begin()); // the turn that does not count

    BenchRow row;
    row.kind       = "update";
    row.map        = "ellipsoid";
    row.nodes      = nodes;
    row.accuracy   = tolerance == PatchSettings{}.tolerance ? "default" : "coarse";
    row.peer       = "paper (published)";
    row.peerMs     = Quartiles{160, 160, 160}; // Kumari & Chaudhuri 2016, section 3; on their machine, error not stated
    row.palpateMs  = timing.front().total;
    row.hidden     = timing.front().hidden;
    row.points     = double(kPoints);
    row.neighbours = double(patch.gathered.size());
    row.iterations = patch.report.iterations;
    row.workUnits  = patch.report.workUnits;
    row.tolerance  = settings.tolerance;
    row.note       = "the published time is of another machine, its error is not stated";
    addParts(row, times);

    const PlateGrid& grid = patch.plate.grid;
    const NodeField  load = footprintLoad(grid, 1, grid.sizeX() / 2, grid.sizeZ() / 2, settings.footprintRadius);
    row.error             = errorOf(patch.response, ReferencePlateSolver(patch.plate).solve(load).deflection);
    return row;
}

} // namespace

const std::vector<std::string>& pointCases()
{
    static const std::vector<std::string> names{"update", "gather", "grid_map"};
    return names;
}

std::vector<BenchRow> measurePoints(const std::vector<std::string>& cases, const std::string& solver,
                                    const std::vector<int>& nodes, int runs, const OnStep& onStep)
{
    const auto            has = [&](const char* kind) { return std::ranges::find(cases, kind) != cases.end(); };
    std::vector<BenchRow> rows;
    const std::size_t     total = 3;
    onStep(0, total);
    if (has("update")) {
        PlateSolver opened(solver);
        for (const int n : nodes)
            for (const double tolerance : {1e-2, 1e-4}) // just below the grid's own error; the default
                if (n >= 65 && n <= 129) rows.push_back(measureUpdate(n, tolerance, runs, opened));
    }
    onStep(1, total);
    if (has("gather"))
        for (BenchRow& row : measureGather(runs)) rows.push_back(std::move(row));
    onStep(2, total);
    if (has("grid_map"))
        for (const int n : nodes)
            if (n <= 257) rows.push_back(measureGridMap(n, runs));
    return rows;
}

} // namespace palp::bench
