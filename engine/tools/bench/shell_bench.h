#pragma once
#include <string>
#include <vector>

#include "engine/tools/bench/bench_row.h"
#include "engine/tools/bench/plate_bench.h"

namespace palp::bench {

/// Lists the cases: shell.
[[nodiscard]] const std::vector<std::string>& shellCases();

/// Measures what it costs that a patch is curved: the table of 9 and 49 footprints on a new map of a spherical shell,
/// eight lengths wide, beside that on the same map of a flat plate with the same edges. Of the shell a mean curvature
/// is met for the first time, or again, see solveTable(). The error is the largest one of a compliance, against the
/// reference solver on the same grid.
/// \param nodes, maps  as measureTables()
/// \thread one; see takeTurns
[[nodiscard]] std::vector<BenchRow> measureShells(const std::string& solver, const std::vector<int>& nodes,
                                                  const std::vector<std::string>& maps, int runs, const OnStep& onStep);

} // namespace palp::bench
