#include "engine/tools/bench/batch_bench.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/compute/command_list.h"
#include "engine/compute/context.h"
#include "engine/tools/bench/bench_plates.h"

namespace palp::bench {
namespace {

/// Bytes per node of one application of the operator: it reads deflection, rigidity, force and divisor, and writes a
/// deflection.
constexpr double kBytesPerNode = 5 * sizeof(float); // [byte]

constexpr double kTolerance = 1e-4; // [1]

/// Returns fingertips a millimetre apart, as the tables for a moving hand take them.
std::vector<NodeField> fingertips(const PlateGrid& grid, int count)
{
    const int              side = int(std::lround(std::sqrt(count)));
    std::vector<NodeField> loads;
    for (int n = 0; n < count; ++n)
        loads.push_back(fingertip(grid, 0.5 + 1e-3 * (n / side - (side - 1) / 2.0) / grid.sizeX(),
                                  0.5 + 1e-3 * (n % side - (side - 1) / 2.0) / grid.sizeZ()));
    return loads;
}

/// Measures how fast the processor copies its own memory, reading and writing counted [GB/s]; empty without a clock.
std::optional<double> copyBandwidth(compute::Context& context)
{
    constexpr std::size_t kBytes  = 64 << 20; // beyond most caches
    constexpr int         kCopies = 8;
    const compute::Buffer from(context, "copied", kBytes, compute::Intent::processor),
        to(context, "copy", kBytes, compute::Intent::processor);
    compute::CommandList list(context);
    list.fill(from, 1);
    list.copy(from, to);
    list.timestamp();
    for (int n = 0; n < kCopies; ++n) list.copy(from, to);
    list.timestamp();
    list.end();
    context.run(list);
    const auto times = list.timestampsMilliseconds();
    if (times.empty() || !(times.back() > 0)) return {};
    return 2.0 * kCopies * double(kBytes) / times.back() / 1e6;
}

} // namespace

std::vector<BenchRow> measureBatches(compute::Context& context, const PlateKernels& kernels, int nodes, int runs)
{
    const Plate                 plate = plateOf(mapNamed("linear"), nodes);
    const std::optional<double> copy  = copyBandwidth(context);
    std::vector<BenchRow>       rows;
    for (const int count : {1, 9, 25, 49}) {
        const std::vector<NodeField> loads = fingertips(plate.grid, count);
        MultigridPlateSolver         solver(context, kernels, plate, {.tolerance = kTolerance, .loads = count});
        SolveReport                  report;
        std::vector<double>          processor; // [ms]
        const Timing                 timing = takeTurns({{"Palpate",
                                                          {[&] { solver.setRigidity(plate.rigidity); },
                                                           [&] {
                                               report = solver.solve(loads).front().report;
                                               if (report.processorMilliseconds)
                                                   processor.push_back(*report.processorMilliseconds);
                                           }},
                                                          clockOf(context)}},
                                                        runs)
                                  .front();
        BenchRow row;
        row.kind               = "batch";
        row.map                = "linear";
        row.nodes              = nodes;
        row.loads              = count;
        row.palpateMs          = timing.total;
        row.hidden             = timing.hidden;
        row.partNames          = {"rigidity", "solve"};
        row.tolerance          = kTolerance;
        row.iterations         = report.iterations;
        row.workUnits          = report.workUnits;
        row.dispatchesPerCycle = solver.dispatchesPerCycle();
        row.copyGigabytes      = copy;
        for (const Quartiles& part : timing.parts) row.palpatePartsMs.push_back(part.median);
        if (!processor.empty())
            row.movedGigabytes = *report.workUnits * double(plate.grid.nodes()) * count * kBytesPerNode /
                                 quartiles(processor).median / 1e6;
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace palp::bench
