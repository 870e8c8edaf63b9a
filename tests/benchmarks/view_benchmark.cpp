// Time of a picture of the ellipsoid at 1280 x 720, touched: fine as for stills, and fast as in the window, all of it
// or only the dent.
#include <map>
#include <memory>

#include <benchmark/benchmark.h>

#include "engine/cloud/samples.h"
#include "engine/pipeline/deform.h"
#include "engine/tools/render/surface_renderer.h"
#include "engine/tools/render/touch_view.h"

namespace {

using namespace palp;

struct Touched {
    SoftObject    object;
    PatchSettings settings;
    Patch         patch;
    TouchView     view;

    static PatchSettings settingsOf(const Sample& sample)
    {
        PatchSettings settings;
        settings.foundation      = sample.foundation;
        settings.window          = sample.window;
        settings.footprintRadius = sample.footprintRadius;
        return settings;
    }
    static Patch patchOf(const Sample& sample, const SoftObject& object, const PatchSettings& settings)
    {
        PlateSolver host("host");
        return deform(object, touchAt(object, sample.place, sample.from, settings.window / 4), settings, host);
    }

    explicit Touched(std::size_t points, const Sample& sample = sampleNamed("ellipsoid"))
        : object(makeSample(sample, points, 1), sample.material), settings(settingsOf(sample)),
          patch(patchOf(sample, object, settings)), view(object, settings)
    {
    }
};

Touched& touched(std::size_t points)
{
    static std::map<std::size_t, std::unique_ptr<Touched>> all;
    auto&                                                  one = all[points];
    if (!one) one = std::make_unique<Touched>(points);
    return *one;
}

SurfaceRenderer& renderer()
{
    static SurfaceRenderer one;
    return one;
}

const PictureSize kFine{1280, 720, 1, Detail::fine}, kFast{1280, 720, 1, Detail::fast};

Camera cameraOf(const Touched& t)
{
    return framed(Camera{{}, glm::normalize(glm::dvec3(1, -2, 2)), {0, 0, 1}}, {0, 0, 0},
                  0.5 * t.object.cloud().bounds().diagonal(), 16.0 / 9);
}

/// The eye moves, and so all of the picture does.
void draw(benchmark::State& state)
{
    Touched&           t    = touched(std::size_t(state.range(0)));
    const PictureSize& size = state.range(1) ? kFast : kFine;
    t.view.show(&t.patch, 1.0, {});
    Camera camera = cameraOf(t);
    static_cast<void>(renderer().draw(t.view.scene(), camera, size)); // compiles the shaders
    for (auto _ : state) {
        camera = orbited(camera, {1e-3, 0});
        benchmark::DoNotOptimize(renderer().draw(t.view.scene(), camera, size));
    }
}
BENCHMARK(draw)
    ->ArgNames({"points", "fast"})
    ->ArgsProduct({{40000, 200000}, {0, 1}})
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

/// The hand presses harder and softer, and only the dent changes.
void drawTouched(benchmark::State& state)
{
    Touched& t     = touched(std::size_t(state.range(0)));
    double   force = 1;
    t.view.show(&t.patch, force, {});
    const Camera camera = cameraOf(t);
    static_cast<void>(renderer().draw(t.view.scene(), camera, kFast));
    for (auto _ : state) {
        t.view.show(&t.patch, force = 3 - force, {});
        benchmark::DoNotOptimize(renderer().draw(t.view.scene(), camera, kFast));
    }
}
BENCHMARK(drawTouched)
    ->ArgNames({"points"})
    ->Arg(40000)
    ->Arg(200000)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void bend(benchmark::State& state)
{
    Touched& t     = touched(std::size_t(state.range(0)));
    double   force = 1;
    for (auto _ : state) t.view.show(&t.patch, force = 3 - force, {});
}
BENCHMARK(bend)->ArgNames({"points"})->Arg(40000)->Arg(200000)->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
