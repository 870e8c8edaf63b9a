// Compute time of the proxy per tick: sliding at depth 5 spacings over a random plane with noise of 0.2 spacings, in
// circles, so that the neighbourhood is always new. The mixed clouds have nine tenths of their points in the middle,
// `ratio` times closer than outside, and the circle lies half inside of it; lengths are in spacings of the middle,
// the noise in those of the place. Counters in microseconds; the mean is Google Benchmark's own.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
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
    std::vector<glm::dvec3>           points; ///< [m]
    std::unique_ptr<palp::SoftObject> object;
    double                            half; ///< [spacings] of the side

    Scene(std::size_t count, int ratio) : half(0.5 * std::sqrt((ratio > 1 ? 0.9 : 1) * double(count)))
    {
        std::mt19937_64                  random(1);
        std::uniform_real_distribution<> unit(-1, 1);
        std::normal_distribution<>       noise(0, 0.2);
        const auto                       add = [&](std::size_t many, double spacing, double inner, double outer) {
            for (std::size_t i = 0; i < many;) {
                const double x = outer * unit(random), y = outer * unit(random);
                if (std::max(std::abs(x), std::abs(y)) < inner) continue;
                points.push_back(kSpacing * glm::dvec3(x, y, spacing * noise(random)));
                ++i;
            }
        };
        const std::size_t sparse = ratio > 1 ? count / 10 : 0;
        add(count - sparse, 1, 0, half);
        if (sparse > 0) add(sparse, ratio, half, std::sqrt(half * half + 0.25 * double(sparse) * ratio * ratio));
        object = std::make_unique<palp::SoftObject>(
            palp::PointCloud(points, std::vector<double>(points.size(), 1e6), palp::StiffnessKind::modulus));
    }
};

Scene& sceneOf(std::size_t count, int ratio)
{
    static std::map<std::pair<std::size_t, int>, std::unique_ptr<Scene>> scenes;
    auto&                                                                scene = scenes[{count, ratio}];
    if (!scene) scene = std::make_unique<Scene>(count, ratio);
    return *scene;
}

double quantile(std::vector<double>& values, double share)
{
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return 1e6 * *at;
}

struct Case {
    std::size_t     count = 0;
    palp::ProxyForm form  = palp::ProxyForm::hybrid;
    double          speed = 0.1; ///< [spacings] per tick
    int             ratio = 1;   ///< of spacings outside and in the middle
};

void slide(benchmark::State& state, const Case& what)
{
    const Scene& scene  = sceneOf(what.count, what.ratio);
    const double loaded = computeTime();
    palp::Proxy  proxy(*scene.object, {what.form});
    state.counters["load_s"] = computeTime() - loaded;

    // A mixed cloud's circle lies about a place of the border.
    const double     radius = what.ratio > 1 ? std::min(3.0 * what.ratio, 0.6 * scene.half) : 0.6 * scene.half;
    const glm::dvec3 centre = what.ratio > 1 ? glm::dvec3(scene.half, 0, 0) : glm::dvec3(0);
    const auto       hip    = [&](double tick) {
        const double angle = what.speed * tick / radius;
        return kSpacing * (centre + glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), -5));
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

void add(const Case& what)
{
    const char* density = what.ratio > 1 ? "/1:" : "";
    std::string title   = std::to_string(what.count) + "/" + palp::name(what.form) + density;
    if (what.ratio > 1) title += std::to_string(what.ratio);
    title += what.speed < 0.3 ? "/0.1 per tick" : "/0.5 per tick";
    benchmark::RegisterBenchmark(title.c_str(), [=](benchmark::State& state) { slide(state, what); })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond)
        ->Iterations(what.form == palp::ProxyForm::hybrid ? 20000 : 5000);
}

} // namespace

int main(int argc, char** argv)
{
    using enum palp::ProxyForm;
    for (const std::size_t count : {40'000, 1'000'000}) {
        for (const double speed : {0.1, 0.5}) add({count, hybrid, speed, 1});
        for (const int ratio : {10, 40, 100})
            for (const double speed : {0.1, 0.5}) add({count, hybrid, speed, ratio});
        add({count, sphere, 0.1, 1});
    }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
