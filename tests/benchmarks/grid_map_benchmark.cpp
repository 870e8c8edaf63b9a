// The nearest of scattered points for every node of a grid, against a plain bucket grid and nanoflann in two
// dimensions. Times are per node and include everything from the bare points: buckets, trees, memory.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/chart/nearest_map.h"
#include "engine/tools/bench/nanoflann_search.h"
#include "engine/tools/bench/point_scenes.h"
#include "tests/benchmarks/peers.h"

namespace {

using palp::ChartPoint;
using palp::PlateGrid;

using Task = palp::bench::GridMapScene;

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
                    [leaf](const Task& t) { return palp::bench::nanoflannMap(t.grid, t.origin, t.points, leaf); });
        }
    return palp::bench::runPeers(argc, argv);
}
