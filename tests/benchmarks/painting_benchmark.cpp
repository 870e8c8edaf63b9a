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
    palp::SoftObject        object{plate()};
    palp::StiffnessPainting painting{object};
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

/// Places of dabs: each an eighth of a radius beside the one before, as a hand goes, or anywhere, where nothing that is
/// read is in a cache.
class Places {
public:
    Places(double radius, bool anywhere) : step_(radius / 8), anywhere_(anywhere) {}

    glm::dvec3 next()
    {
        if (anywhere_) return {along_(random_), along_(random_), 0};
        place_.x += step_;
        if (place_.x > kReach) place_ = {-kReach, place_.y > kReach ? -kReach : place_.y + step_, 0};
        return place_;
    }

private:
    static constexpr double          kReach = 0.08; // [m] well inside the plate
    double                           step_;
    bool                             anywhere_;
    glm::dvec3                       place_{-kReach, -kReach, 0};
    std::mt19937_64                  random_{2};
    std::uniform_real_distribution<> along_{-kReach, kReach};
};

/// Arguments: points, and 1 if the dabs are anywhere.
template <class Dab>
void dabs(benchmark::State& state, const Dab& dab)
{
    const double radius = radiusFor(double(state.range(0)));
    Places       places(radius, state.range(1) == 1);
    std::size_t  points   = 0;
    auto&        painting = stage().painting;
    for (auto _ : state) points += dab(painting, palp::Brush{places.next(), radius, 0.5}).size();
    state.counters["points"] = double(points) / double(state.iterations());
    while (!painting.undo().empty()) {
    }
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
    palp::SurfaceFlood flood(stage().object);
    const double       radius = radiusFor(double(state.range(0)));
    Places             places(radius, state.range(1) == 1);
    for (auto _ : state) benchmark::DoNotOptimize(flood.reach(places.next(), radius));
}

void cases(benchmark::internal::Benchmark* benchmark)
{
    for (const int anywhere : {0, 1})
        for (const int points : {200, 2000, 20'000}) benchmark->Args({points, anywhere});
    benchmark->Unit(benchmark::kMicrosecond);
}

BENCHMARK(flood)->Apply(cases);
BENCHMARK(paint)->Apply(cases);
BENCHMARK(smooth)->Apply(cases);

} // namespace

BENCHMARK_MAIN();
