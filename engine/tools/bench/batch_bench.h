#pragma once
#include <vector>

#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/tools/bench/bench_row.h"

namespace palp::bench {

/// Measures the case `batch`: a new map and a cold solve of 1, 9, 25 and 49 fingertips that share every pass, to the
/// tolerance 1e-4, with the dispatches of a cycle and the bytes that it moves. There is no peer.
/// \param nodes  a side
/// \thread one; see takeTurns
[[nodiscard]] std::vector<BenchRow> measureBatches(compute::Context& context, const PlateKernels& kernels, int nodes,
                                                   int runs);

} // namespace palp::bench
