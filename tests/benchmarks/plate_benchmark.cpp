// A new map of rigidity and one solve, against direct solvers whose symbolic analysis is made before. Times are per
// plate. `palpate bench plate` has the same comparison with the error of each beside it; this one is for profiling.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/compute/context.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/one_thread.h"
#include "engine/tools/bench/outside_peers.h"
#include "tests/benchmarks/peers.h"

namespace {

using namespace palp;

template <class Solve>
void add(const std::string& name, Solve solve)
{
    benchmark::RegisterBenchmark(name.c_str(), [solve](benchmark::State& state) {
        for (auto _ : state) solve();
        state.SetItemsProcessed(state.iterations());
    })->MeasureProcessCPUTime(); // drivers in software have threads of their own
}

void addDirect(const std::string& name, const Plate& plate,
               const std::function<std::unique_ptr<bench::DirectSolver>(const PlateMatrix&)>& make)
{
    const auto direct = std::make_shared<bench::Direct>(bench::Direct{PlateMatrix(plate), {}});
    direct->solver    = make(direct->matrix);
    add(name, [direct, plate, force = bench::fingertip(plate.grid)] {
        direct->factorise(plate);
        benchmark::DoNotOptimize(direct->solve(force));
    });
}

} // namespace

int main(int argc, char** argv)
{
    bench::becomeOneThread(bench::runningProgram());
    compute::Context context;
    std::fprintf(stderr, "palpate on %s\n", context.device().name.c_str());
    const PlateKernels kernels(context);
    for (const int nodes : {65, 129, 257}) {
        const std::string work  = std::to_string(nodes) + " nodes/";
        const Plate       plate = bench::plateOf(bench::mapNamed("linear"), nodes);
        for (const double tolerance : {1e-2, 1e-5}) {
            const auto ours = std::make_shared<MultigridPlateSolver>(
                context, kernels, plate, MultigridPlateSolver::Settings{.tolerance = tolerance});
            add(work + "palpate " + std::to_string(tolerance), [ours, plate, force = bench::fingertip(plate.grid)] {
                ours->setRigidity(plate.rigidity);
                benchmark::DoNotOptimize(ours->solve(force));
            });
        }
        addDirect(work + "Eigen SimplicialLDLT", plate, bench::eigenSolver);
        if (bench::outsidePeers().cholmod) addDirect(work + "CHOLMOD", plate, bench::outsidePeers().cholmod);
    }
    return bench::runPeers(argc, argv);
}
