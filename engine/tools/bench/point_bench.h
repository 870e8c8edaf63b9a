#pragma once
#include <string>
#include <vector>

#include "engine/tools/bench/bench_row.h"
#include "engine/tools/bench/plate_bench.h"

namespace palp::bench {

/// Lists the cases: gather, grid_map, update.
[[nodiscard]] const std::vector<std::string>& pointCases();

/// Measures the cases that begin with points: a radius search, the nearest point of every node, and a whole update.
/// \param solver  of update, as PlateSolver takes it
/// \param nodes   a side of the grids, odd
[[nodiscard]] std::vector<BenchRow> measurePoints(const std::vector<std::string>& cases, const std::string& solver,
                                                  const std::vector<int>& nodes, int runs, const OnStep& onStep);

} // namespace palp::bench
