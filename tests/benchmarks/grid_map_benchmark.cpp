// The nearest of scattered points for every node of a grid, against a plain bucket grid and nanoflann in two
// dimensions. Times are per node and include everything from the bare points: buckets, trees, memory.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <nanoflann.hpp>

#include "engine/chart/nearest_map.h"
#include "engine/cloud/morton.h"
#include "tests/benchmarks/peers.h"

namespace {

using palp::ChartPoint;
using palp::PlateGrid;

struct Task {
    PlateGrid               grid;
    ChartPoint              origin; ///< [m]
    std::vector<ChartPoint> points; ///< [m] in Morton order, as a radius search over a cloud delivers them

    Task(int nodes, double perCell)
        : grid{nodes - 1, nodes - 1, 1e-3, 1e-3}, origin{-0.5 * grid.sizeX(), -0.5 * grid.sizeZ()}
    {
        // A disc that holds the grid, as a gather radius does.
        const double                     radius = 0.75 * grid.sizeX();
        const double                     square = 4 * radius * radius / (grid.spacingX * grid.spacingZ);
        std::mt19937                     random(4);
        std::uniform_real_distribution<> along(-radius, radius);
        const auto cell = [radius](double x) { return std::uint32_t((x / radius + 1) / 2 * (palp::kMortonCells - 1)); };
        std::vector<std::pair<std::uint64_t, ChartPoint>> keyed;
        for (std::size_t p = 0; p < std::size_t(square * perCell); ++p) {
            const ChartPoint at{along(random), along(random)};
            if (std::hypot(at.x, at.z) > radius) continue;
            keyed.push_back({palp::mortonCode(cell(at.x), cell(at.z), 0), at});
        }
        std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [code, at] : keyed) points.push_back(at);
    }
};

/// The textbook way: points sorted into square cells of the grid, rings of cells around each node.
std::vector<std::uint32_t> byPlainBuckets(const Task& task)
{
    const PlateGrid&               grid   = task.grid;
    const ChartPoint&              origin = task.origin;
    const std::vector<ChartPoint>& points = task.points;
    const int                      rows = grid.nodesX(), columns = grid.nodesZ();
    const auto                     along = [](double x, double low, double step, int count) {
        return int(std::clamp((x - low) / step + 0.5, 0.0, count - 1.0));
    };
    const auto bucketOf = [&](const ChartPoint& p) {
        return along(p.x, origin.x, grid.spacingX, rows) * columns + along(p.z, origin.z, grid.spacingZ, columns);
    };
    std::vector<std::uint32_t> first(std::size_t(rows * columns) + 1), sorted(points.size());
    for (const ChartPoint& p : points) ++first[std::size_t(bucketOf(p)) + 1];
    for (std::size_t b = 1; b < first.size(); ++b) first[b] += first[b - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t p = 0; p < points.size(); ++p) sorted[next[std::size_t(bucketOf(points[p]))]++] = p;

    std::vector<std::uint32_t> nearest;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            double        best  = std::numeric_limits<double>::infinity();
            std::uint32_t which = 0;
            for (int ring = 0; ring <= std::max(rows, columns); ++ring) {
                const double gap = std::max(0.0, ring - 0.5) * grid.spacingX;
                if (gap * gap > best) break;
                for (int r = std::max(0, i - ring); r <= std::min(rows - 1, i + ring); ++r) {
                    const int step = std::abs(r - i) == ring || ring == 0 ? 1 : 2 * ring;
                    for (int c = j - ring; c <= j + ring; c += step) {
                        if (c < 0 || c >= columns) continue;
                        const auto b = std::size_t(r * columns + c);
                        for (std::uint32_t s = first[b]; s < first[b + 1]; ++s) {
                            const double dx = origin.x + i * grid.spacingX - points[sorted[s]].x;
                            const double dz = origin.z + j * grid.spacingZ - points[sorted[s]].z;
                            const double d2 = dx * dx + dz * dz;
                            if (d2 < best || (d2 == best && sorted[s] < which)) {
                                best  = d2;
                                which = sorted[s];
                            }
                        }
                    }
                }
            }
            nearest.push_back(which);
        }
    return nearest;
}

struct FloatPoints {
    std::vector<std::array<float, 2>> points;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float       kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};
using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, FloatPoints>, FloatPoints, 2,
                                                   std::uint32_t>;

std::vector<std::uint32_t> byNanoflann(const Task& task, std::size_t leaf)
{
    FloatPoints floats;
    for (const ChartPoint& p : task.points) floats.points.push_back({float(p.x), float(p.z)});
    const KdTree               tree(2, floats, nanoflann::KDTreeSingleIndexAdaptorParams(leaf));
    std::vector<std::uint32_t> nearest(task.grid.nodes());
    std::size_t                node = 0;
    for (int i = 0; i < task.grid.nodesX(); ++i)
        for (int j = 0; j < task.grid.nodesZ(); ++j) {
            const float place[]{float(task.origin.x + i * task.grid.spacingX),
                                float(task.origin.z + j * task.grid.spacingZ)};
            float       distance2 = 0;
            tree.knnSearch(place, 1, &nearest[node++], &distance2);
        }
    return nearest;
}

template <class Map>
void add(const std::string& name, const Task& task, Map map)
{
    benchmark::RegisterBenchmark(name.c_str(), [&task, map](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(map(task));
        state.SetItemsProcessed(state.iterations() * std::int64_t(task.grid.nodes()));
    });
}

} // namespace

int main(int argc, char** argv)
{
    static std::vector<std::unique_ptr<Task>> tasks;
    for (const int nodes : {65, 129, 257})
        for (const char* perCell : {"0.1", "0.5", "1", "2", "4"}) {
            const Task&       task = *tasks.emplace_back(std::make_unique<Task>(nodes, std::stod(perCell)));
            const std::string work = std::to_string(nodes) + " nodes " + perCell + " per cell/";
            const auto        ours = [](const Task& t) { return palp::nearestPoint(t.grid, t.origin, t.points); };
            if (ours(task) != byPlainBuckets(task)) std::printf("%s: the answers differ\n", work.c_str());
            add(work + "palpate", task, ours);
            add(work + "plain buckets", task, byPlainBuckets);
            for (const std::size_t leaf : {5, 10, 20})
                add(work + "nanoflann leaf " + std::to_string(leaf), task,
                    [leaf](const Task& t) { return byNanoflann(t, leaf); });
        }
    return palp::bench::runPeers(argc, argv);
}
