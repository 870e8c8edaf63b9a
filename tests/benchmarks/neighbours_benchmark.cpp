// Radius and nearest-point search in a cloud sampled from a surface, against nanoflann. Both get the same points in
// Morton order and the same random centres; nanoflann works in floats, unsorted, with the best of several leaf sizes.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/tools/bench/nanoflann_search.h"
#include "engine/tools/bench/point_scenes.h"
#include "tests/benchmarks/peers.h"

namespace {

using palp::NeighbourIndex;

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A cloud, the indices over it and the places to search around.
struct Scene {
    static constexpr std::size_t kCentres = 4096;

    std::vector<glm::dvec3>                                           cloud;
    std::unique_ptr<NeighbourIndex>                                   ours;
    std::map<std::size_t, std::unique_ptr<palp::bench::RadiusSearch>> trees; ///< by leaf size
    std::vector<glm::dvec3> centres; ///< [m] points of the cloud, moved by less than the mean distance

    explicit Scene(std::size_t points) : cloud(palp::bench::bumpyBall(points))
    {
        const auto start = std::chrono::steady_clock::now();
        ours             = std::make_unique<NeighbourIndex>(cloud);
        std::printf("%zu points: palpate builds in %.3f s, spacing %.3g m;", points, secondsSince(start),
                    ours->spacing());
        for (const std::size_t leaf : {10, 20, 30, 50}) {
            const auto begin = std::chrono::steady_clock::now();
            trees[leaf]      = palp::bench::nanoflannSearch(cloud, leaf);
            std::printf(" nanoflann(%zu) %.3f s", leaf, secondsSince(begin));
        }
        std::printf("\n");
        centres = palp::bench::searchPlaces(cloud, ours->spacing(), kCentres);
    }

    /// [m] of a ball that holds `neighbours` points on average.
    [[nodiscard]] double radiusFor(double neighbours) const
    {
        return ours->spacing() * std::sqrt(neighbours / std::numbers::pi);
    }
};

template <class Query>
void add(const std::string& name, const Scene& scene, Query query)
{
    benchmark::RegisterBenchmark(name.c_str(), [&scene, query](benchmark::State& state) mutable {
        std::size_t i = 0;
        for (auto _ : state) benchmark::DoNotOptimize(query(scene.centres[i++ % Scene::kCentres]));
        state.SetItemsProcessed(state.iterations());
    });
}

void addScene(const Scene& scene)
{
    const std::string size = std::to_string(scene.cloud.size() / 1000) + "k/";
    for (const int neighbours : {30, 300, 1000, 3000}) {
        const std::string work   = size + "gather " + std::to_string(neighbours) + "/";
        const double      radius = scene.radiusFor(neighbours);
        add(work + "palpate", scene,
            [&scene, radius, found = std::vector<std::uint32_t>()](const glm::dvec3& c) mutable {
                scene.ours->gather(c, radius, found);
                return found.size();
            });
        for (const auto& [leaf, tree] : scene.trees) {
            add(work + "nanoflann leaf " + std::to_string(leaf), scene,
                [&t    = *tree, radius,
                 found = std::vector<std::pair<std::uint32_t, float>>()](const glm::dvec3& c) mutable {
                    t.gather(c, radius, found);
                    return found.size();
                });
        }
    }
    for (const std::size_t k : {7, 30, 300}) {
        const std::string work = size + "nearest " + std::to_string(k) + "/";
        add(work + "palpate", scene,
            [&scene, k](const glm::dvec3& c) { return scene.ours->nearest(c, k).back().point; });
        for (const auto& [leaf, tree] : scene.trees) {
            add(work + "nanoflann leaf " + std::to_string(leaf), scene,
                [&t = *tree, points = std::vector<std::uint32_t>(k)](const glm::dvec3& c) mutable {
                    t.nearest(c, points);
                    return points.back();
                });
        }
    }
}

} // namespace

int main(int argc, char** argv)
{
    const Scene small(400'000);
    const Scene large(4'000'000);
    addScene(small);
    addScene(large);
    return palp::bench::runPeers(argc, argv);
}
