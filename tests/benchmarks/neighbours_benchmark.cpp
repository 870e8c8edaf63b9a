// Radius and nearest-point search in a cloud sampled from a surface, against nanoflann. Both get the same points in
// Morton order and the same random centres; nanoflann works in floats, unsorted, with the best of several leaf sizes.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <nanoflann.hpp>

#include "engine/cloud/morton.h"
#include "engine/cloud/neighbour_index.h"
#include "tests/benchmarks/peers.h"

namespace {

using palp::NeighbourIndex;

constexpr double kRadius = 0.1; ///< [m] of the bumpy ball that the points lie on

/// Uniform enough points on a ball with bumps, in Morton order.
std::vector<glm::dvec3> surfaceCloud(std::size_t points)
{
    std::mt19937_64            random(7);
    std::normal_distribution<> normal;
    const auto                 cell = [](double x) {
        return std::uint32_t((x / kRadius + 2) / 4 * palp::kMortonCells); // the bumps stay within 2 radii
    };
    std::vector<std::pair<std::uint64_t, glm::dvec3>> keyed(points);
    for (auto& [code, p] : keyed) {
        p    = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        p    = p * kRadius * (1 + 0.05 * std::sin(9 * p.x) * std::sin(9 * p.y) * std::sin(9 * p.z));
        code = palp::mortonCode(cell(p.x), cell(p.y), cell(p.z));
    }
    std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<glm::dvec3> cloud(points);
    std::transform(keyed.begin(), keyed.end(), cloud.begin(), [](const auto& k) { return k.second; });
    return cloud;
}

struct FloatCloud {
    std::vector<std::array<float, 3>> points;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float       kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};
using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, FloatCloud>, FloatCloud, 3, std::uint32_t>;

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A cloud, the indices over it and the places to search around.
struct Scene {
    static constexpr std::size_t kCentres = 4096;

    std::vector<glm::dvec3>                        cloud;
    std::unique_ptr<NeighbourIndex>                ours;
    FloatCloud                                     floats;
    std::map<std::size_t, std::unique_ptr<KdTree>> trees; ///< by leaf size
    std::vector<glm::dvec3> centres; ///< [m] points of the cloud, moved by less than the mean distance

    explicit Scene(std::size_t points) : cloud(surfaceCloud(points))
    {
        const auto start = std::chrono::steady_clock::now();
        ours             = std::make_unique<NeighbourIndex>(cloud);
        std::printf("%zu points: palpate builds in %.3f s, spacing %.3g m;", points, secondsSince(start),
                    ours->spacing());
        for (const glm::dvec3& p : cloud) floats.points.push_back({float(p.x), float(p.y), float(p.z)});
        for (const std::size_t leaf : {10, 20, 30, 50}) {
            const auto begin = std::chrono::steady_clock::now();
            trees[leaf]      = std::make_unique<KdTree>(3, floats, nanoflann::KDTreeSingleIndexAdaptorParams(leaf));
            std::printf(" nanoflann(%zu) %.3f s", leaf, secondsSince(begin));
        }
        std::printf("\n");
        std::mt19937_64                  random(11);
        std::uniform_real_distribution<> shift(-0.5 * ours->spacing(), 0.5 * ours->spacing());
        for (std::size_t i = 0; i < kCentres; ++i)
            centres.push_back(cloud[random() % points] + glm::dvec3(shift(random), shift(random), shift(random)));
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
                    const float place[]{float(c.x), float(c.y), float(c.z)};
                    const float radius2 = float(radius * radius); // nanoflann's distances are squared
                    return t.radiusSearch(place, radius2, found, nanoflann::SearchParams(0, 0, false));
                });
        }
    }
    for (const std::size_t k : {7, 30, 300}) {
        const std::string work = size + "nearest " + std::to_string(k) + "/";
        add(work + "palpate", scene,
            [&scene, k](const glm::dvec3& c) { return scene.ours->nearest(c, k).back().point; });
        for (const auto& [leaf, tree] : scene.trees) {
            add(work + "nanoflann leaf " + std::to_string(leaf), scene,
                [&t = *tree, k, points = std::vector<std::uint32_t>(k),
                 d2 = std::vector<float>(k)](const glm::dvec3& c) mutable {
                    const float place[]{float(c.x), float(c.y), float(c.z)};
                    t.knnSearch(place, k, points.data(), d2.data());
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
