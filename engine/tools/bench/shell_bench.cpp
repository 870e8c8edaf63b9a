#include "engine/tools/bench/shell_bench.h"

#include <algorithm>
#include <cmath>

#include "engine/pipeline/compliance_table_solve.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/cpu_time.h"
#include "engine/tools/bench/table_bench.h"

namespace palp::bench {
namespace {

constexpr double     kLengths   = 8;    // over which dents die away, in the window [1]
constexpr double     kThickness = 1e-3; // [m]
constexpr PlateEdges kSupported{Edge::supported, Edge::supported, Edge::supported, Edge::supported};

/// Returns a shell with the rigidity of a plate, as curved as a sphere.
/// \param times  a curvature over that whose length goes eight times into the window [1]
Shell sphereOf(const Plate& plate, double times)
{
    const double length = plate.grid.sizeX() / kLengths;
    const double k = times * kThickness / (std::sqrt(12 * (1 - std::pow(plate.poissonRatio, 2))) * length * length);
    NodeField    membrane(plate.grid); // 1/(E h) = h^2 / (12 (1 - nu^2) D)
    for (std::size_t n = 0; n < membrane.values().size(); ++n)
        membrane.values()[n] =
            kThickness * kThickness / (12 * (1 - std::pow(plate.poissonRatio, 2)) * plate.rigidity.values()[n]);
    return {plate, membrane, kSupported, NodeField(plate.grid, k), NodeField(plate.grid, k), NodeField(plate.grid)};
}

double largestError(const FootprintSolution& found, const FootprintSolution& truth)
{
    double most = 0;
    for (std::size_t n = 0; n < truth.responses.size(); ++n)
        most = std::max(most, std::abs(found.responses[n].work / truth.responses[n].work - 1));
    return most;
}

std::vector<BenchRow> measureShell(const Map& map, int nodes, int side, int runs, PlateSolver& solver)
{
    Plate plate                    = plateOf(map, nodes);
    plate.edges                    = kSupported;
    Plate even                     = plate;
    even.rigidity                  = NodeField(plate.grid, kSoftest);
    const FootprintLattice lattice = solveLattice(even, {kTableRadius, side, 1e9}, solver, kTableTolerance);
    const Shell            shell   = sphereOf(plate, 1);

    double             times = 1;
    ComplianceTable    table;
    std::optional<int> steps[3]; // of the three contestants
    const auto         bend = [&](const auto& what, int which) {
        steps[which] =
            solveTable(what, plate.foundation, lattice, solver, kTableTolerance, table).solution.report.iterations;
    };
    const Clock               clock   = clockOf(solver);
    const std::vector<Timing> timings = takeTurns({{"a flat plate", {[&] { bend(plate, 0); }}, clock},
                                                   {"again", {[&] { bend(shell, 1); }}, clock},
                                                   {"new", {[&] { bend(sphereOf(plate, times *= 1.03), 2); }}, clock}},
                                                  runs);
    PlateSolver               reference("reference");
    const auto                middle = lattice.loads.size() / 2;
    const double              error =
        largestError(solver.solveFootprints(shell, lattice.loads, middle, kTableTolerance, PlateSolver::kAsWorks),
                     reference.solveFootprints(shell, lattice.loads, middle, kTableTolerance, PlateSolver::kAsWorks));

    std::vector<BenchRow> rows;
    for (const std::size_t n : {1, 2}) {
        BenchRow row;
        row.kind       = "shell";
        row.map        = map.name;
        row.nodes      = nodes;
        row.accuracy   = "1e-4 of c";
        row.target     = kTableTarget;
        row.loads      = side * side;
        row.peer       = "a flat plate";
        row.peerMs     = timings.front().total;
        row.palpateMs  = timings[n].total;
        row.hidden     = timings[n].hidden;
        row.tolerance  = kTableTolerance;
        row.iterations = steps[n];
        row.error      = error;
        row.note       = std::to_string(side * side) + " loads, a mean curvature " +
                   (n == 1 ? "met before" : "met for the first time");
        rows.push_back(std::move(row));
    }
    return rows;
}

} // namespace

const std::vector<std::string>& shellCases()
{
    static const std::vector<std::string> names{"shell"};
    return names;
}

std::vector<BenchRow> measureShells(const std::string& solver, const std::vector<int>& nodes,
                                    const std::vector<std::string>& maps, int runs, const OnStep& onStep)
{
    PlateSolver opened(solver);
    return overTables(nodes, maps, onStep,
                      [&](const Map& map, int n, int side) { return measureShell(map, n, side, runs, opened); });
}

} // namespace palp::bench
