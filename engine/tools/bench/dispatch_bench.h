#pragma once
#include <string>
#include <vector>

#include "engine/compute/context.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/tools/bench/bench_row.h"

namespace palp::bench {

/// Lists the cases: dispatches.
[[nodiscard]] const std::vector<std::string>& dispatchCases();

/// Counts the commands for a new map, for the nested iteration and for a step on the finest grid, with one load: for a
/// smooth map, and for one that jumps. Nothing is timed.
/// \param schedule  automatic: each that the processor has
/// \param nodes     a side of the grids
/// \thread as the context
[[nodiscard]] std::vector<BenchRow> countDispatches(compute::Context& context, Schedule schedule,
                                                    const std::vector<int>& nodes);

} // namespace palp::bench
