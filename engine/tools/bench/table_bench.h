#pragma once
#include <functional>
#include <string>
#include <vector>

#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/bench_row.h"
#include "engine/tools/bench/plate_bench.h"

namespace palp::bench {

inline constexpr double kTableRadius    = 4e-3; ///< of a table's footprints, and from one to the next [m]
inline constexpr double kTableTolerance = 1e-4; ///< of a scene [1]
inline constexpr double kTableTarget    = 1e-4; ///< of a compliance [1]

/// Measures tables on one map, with as many footprints a side.
using MeasureTable = std::function<std::vector<BenchRow>(const Map& map, int nodes, int side)>;

/// Measures tables of 9 and 49 footprints on every grid of 65 to 129 nodes, beyond which no session solves them.
/// \param maps  by name; empty: linear, wart, disc_100
[[nodiscard]] std::vector<BenchRow> overTables(const std::vector<int>& nodes, const std::vector<std::string>& maps,
                                               const OnStep& onStep, const MeasureTable& measure);

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
