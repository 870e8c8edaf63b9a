#include "engine/tools/bench/dispatch_bench.h"

#include "engine/tools/bench/bench_plates.h"

namespace palp::bench {
namespace {

std::vector<Schedule> schedulesOf(const compute::Context& context, Schedule wanted)
{
    if (wanted != Schedule::automatic) return {wanted};
    if (context.processor().kind == compute::ProcessorKind::host) return {Schedule::passByPass};
    return {Schedule::passByPass, Schedule::fused};
}

BenchRow rowOf(const MultigridPlateSolver::CommandCounts& counts, Schedule schedule, std::string_view map, int nodes)
{
    const auto text = [](int count) { return std::to_string(count); };
    BenchRow   row;
    row.kind     = "dispatches";
    row.map      = map;
    row.nodes    = nodes;
    row.schedule = name(schedule);
    row.commands = counts;
    row.note = row.schedule + ": new map " + text(counts.prepare) + " dispatches and " + text(counts.prepareCopies) +
               " copies, nested iteration " + text(counts.nested) + " dispatches, a step " + text(counts.step) +
               ", of which the cycle " + text(counts.cycle) + ", after the steps of a list " + text(counts.last);
    return row;
}

} // namespace

const std::vector<std::string>& dispatchCases()
{
    static const std::vector<std::string> names{"dispatches"};
    return names;
}

std::vector<BenchRow> countDispatches(compute::Context& context, Schedule schedule, const std::vector<int>& nodes)
{
    std::vector<BenchRow> rows;
    for (const Schedule one : schedulesOf(context, schedule)) {
        const PlateKernels kernels(context, one);
        for (const int side : nodes)
            for (const char* map : {"linear", "disc_100"})
                rows.push_back(
                    rowOf(MultigridPlateSolver(context, kernels, plateOf(mapNamed(map), side), {}).commands(), one, map,
                          side));
    }
    return rows;
}

} // namespace palp::bench
