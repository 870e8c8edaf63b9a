// Compute time of the proxy per tick: sliding at depth 5 spacings over a random plane with noise of 0.2 spacings, in
// circles, so that the neighbourhood is always new. Counters in microseconds; the mean is Google Benchmark's own.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/contact/proxy.h"

namespace {

constexpr double kSpacing = 1e-3; ///< [m]

/// [s] of this thread's computing: what other programs take away from it does not count.
double computeTime()
{
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

struct Scene {
    std::vector<glm::dvec3>               points; ///< [m]
    std::unique_ptr<palp::NeighbourIndex> index;
    double                                half; ///< [spacings] of the side

    explicit Scene(std::size_t count) : half(0.5 * std::sqrt(double(count)))
    {
        std::mt19937_64                  random(1);
        std::uniform_real_distribution<> along(-half, half);
        std::normal_distribution<>       noise(0, 0.2);
        for (std::size_t i = 0; i < count; ++i) {
            const double x = along(random), y = along(random);
            points.push_back(kSpacing * glm::dvec3(x, y, noise(random)));
        }
        index = std::make_unique<palp::NeighbourIndex>(points);
    }
};

Scene& sceneOf(std::size_t count)
{
    static std::map<std::size_t, std::unique_ptr<Scene>> scenes;
    auto&                                                scene = scenes[count];
    if (!scene) scene = std::make_unique<Scene>(count);
    return *scene;
}

double quantile(std::vector<double>& values, double share)
{
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return 1e6 * *at;
}

/// \param speed  [spacings] per tick
void slide(benchmark::State& state, std::size_t count, palp::ProxyForm form, double speed)
{
    const Scene& scene  = sceneOf(count);
    const double loaded = computeTime();
    palp::Proxy  proxy(scene.points, *scene.index, {form});
    state.counters["load_s"] = computeTime() - loaded;

    const double radius = 0.6 * scene.half; // [spacings]
    const auto   hip    = [&](double tick) {
        const double angle = speed * tick / radius;
        return kSpacing * glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), -5);
    };
    proxy.reset(hip(0) + glm::dvec3(0, 0, 20 * kSpacing));
    for (int tick = 0; tick < 100; ++tick) proxy.step(hip(0));

    std::vector<double> times;
    times.reserve(std::size_t(state.max_iterations));
    double tick = 0;
    int    lost = 0;
    for (auto _ : state) {
        const glm::dvec3 now   = hip(++tick);
        const double     start = computeTime();
        lost += !proxy.step(now).touching;
        times.push_back(computeTime() - start);
        state.SetIterationTime(times.back());
    }
    state.counters["median_us"] = quantile(times, 0.5);
    state.counters["p99.9_us"]  = quantile(times, 0.999);
    state.counters["lost"]      = lost;
}

void add(std::size_t count, palp::ProxyForm form, const char* name, double speed)
{
    const std::string title = std::to_string(count) + "/" + name + "/" + (speed < 0.3 ? "0.1" : "0.5") + " per tick";
    benchmark::RegisterBenchmark(title.c_str(), [=](benchmark::State& state) { slide(state, count, form, speed); })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond)
        ->Iterations(form == palp::ProxyForm::hybrid ? 20000 : 5000);
}

} // namespace

int main(int argc, char** argv)
{
    for (const std::size_t count : {40'000, 1'000'000}) {
        for (const double speed : {0.1, 0.5}) add(count, palp::ProxyForm::hybrid, "hybrid", speed);
        add(count, palp::ProxyForm::sphere, "sphere", 0.1);
    }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
