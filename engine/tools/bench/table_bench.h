#pragma once
#include <functional>
#include <string>
#include <vector>

#include "engine/tools/bench/bench_row.h"
#include "engine/tools/bench/plate_bench.h"

namespace palp::bench {

/// Lists the cases: table.
[[nodiscard]] const std::vector<std::string>& tableCases();

/// Measures what a session does with each new patch: the table of compliances of 9 and 49 footprints on a new map of
/// rigidity, beside direct solvers that factorise it and solve for all loads at once. The error is the largest one of a
/// compliance.
/// \param solver  as PlateSolver takes it
/// \param nodes   a side of the grids, odd
/// \param maps    by name; empty: linear, wart, disc_100
/// \thread one; see takeTurns
[[nodiscard]] std::vector<BenchRow> measureTables(const std::string& solver, const std::vector<int>& nodes,
                                                  const std::vector<std::string>& maps, int runs, const OnStep& onStep);

} // namespace palp::bench
