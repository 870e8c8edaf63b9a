// What a dab of a brush takes, which must not be felt while a hand paints: a ball of about 2000 points, on one side of
// a plate whose other side is within the ball too, and a ball of 20 000.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/cloud/stiffness_painting.h"

namespace {

constexpr double kSpacing = 0.5e-3; // [m]

/// Two random sheets of 200 000 points each, `gap` apart [m].
const palp::PointCloud& plate()
{
    static const palp::PointCloud kPlate = [] {
        constexpr std::size_t            kSide = 200'000;
        constexpr double                 kGap  = 3e-3; // [m]
        std::mt19937_64                  random(1);
        const double                     half = kSpacing * std::sqrt(double(kSide)) / 2;
        std::uniform_real_distribution<> along(-half, half);
        std::vector<glm::dvec3>          places(2 * kSide);
        for (std::size_t i = 0; i < places.size(); ++i)
            places[i] = {along(random), along(random), i < kSide ? 0 : -kGap};
        return palp::PointCloud(places, std::vector<double>(places.size(), 3e5), palp::StiffnessKind::modulus);
    }();
    return kPlate;
}

struct Stage {
    palp::NeighbourIndex    index{plate().positions()};
    palp::StiffnessPainting painting{plate(), index};
};

Stage& stage()
{
    static Stage stage;
    return stage;
}

/// The radius that holds so many points of one side [m].
double radiusFor(double points)
{
    return kSpacing * std::sqrt(points / std::numbers::pi);
}

template <class Dab>
void dabs(benchmark::State& state, const Dab& dab)
{
    const double                     radius = radiusFor(double(state.range(0)));
    std::mt19937_64                  random(2);
    std::uniform_real_distribution<> along(-0.08, 0.08); // [m]
    std::size_t                      points = 0;
    Stage&                           s      = stage();
    s.painting.beginStroke();
    for (auto _ : state) {
        const auto covered = dab(s.painting, palp::Brush{{along(random), along(random), 0}, radius, 0.5});
        points += covered.size();
        state.PauseTiming();
        s.painting.beginStroke();
        state.ResumeTiming();
    }
    state.counters["points"] = double(points) / double(state.iterations());
}

void paint(benchmark::State& state)
{
    dabs(state, [](palp::StiffnessPainting& painting, const palp::Brush& brush) { return painting.paint(brush, 2e6); });
}

void smooth(benchmark::State& state)
{
    dabs(state, [](palp::StiffnessPainting& painting, const palp::Brush& brush) { return painting.smooth(brush); });
}

void flood(benchmark::State& state)
{
    palp::SurfaceFlood               flood(plate().positions(), stage().index);
    std::mt19937_64                  random(2);
    std::uniform_real_distribution<> along(-0.08, 0.08); // [m]
    for (auto _ : state)
        benchmark::DoNotOptimize(flood.reach({along(random), along(random), 0}, radiusFor(double(state.range(0)))));
}

BENCHMARK(flood)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK(paint)->Arg(200)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK(smooth)->Arg(200)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);

} // namespace

BENCHMARK_MAIN();
