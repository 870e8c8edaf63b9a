// A felt map of 40 000 points with a touch in each cube of 2 mm, from C++: `felt_map.py` beside this file times the
// same from Python. Time is that of the processor on all cores, which other programs on the machine hardly move, and
// the clock's.
#include <benchmark/benchmark.h>

#include "engine/perception/felt_map.h"
#include "engine/session/scene.h"

namespace {

void feltMap(benchmark::State& state)
{
    const palp::Scene scene =
        palp::parseScene(R"({"cloud": "sample:skin", "points": 40000, "solver": "host"})", "felt_map_benchmark", ".");
    const palp::SoftObject object = palp::loadObject(scene).object;
    std::size_t            places = 0;
    for (auto _ : state) places = palp::feltMapEvery(object, scene.patch, 2e-3, scene.solver).places.size();
    state.counters["places"] = double(places);
}
BENCHMARK(feltMap)
    ->Name("felt map/40000 points/2 mm")
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kSecond)
    ->Iterations(1);

} // namespace

BENCHMARK_MAIN();
