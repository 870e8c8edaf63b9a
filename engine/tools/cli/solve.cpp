#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/npy.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/plate/load.h"
#include "engine/plate/problem_file.h"
#include "engine/plate/report_text.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/solver_choice.h"

namespace palp {
namespace {

struct SolveOptions {
    std::string        problem;
    std::optional<int> cells;
    SolverChoice       solver;
    bool               json = false;
    std::string        out;
};

/// A problem with its answer.
struct Solved {
    PlateProblem        problem;
    PlateSolution       solution;
    std::vector<double> probeDeflections; ///< [m] one per probe
    std::size_t         largestNode = 0;  ///< of the deflection of largest magnitude
    std::string         note{};           ///< of the solver

    [[nodiscard]] double largest() const { return solution.deflection.values()[largestNode]; } ///< [m] with its sign
    [[nodiscard]] Probe  largestPlace() const
    {
        const PlateGrid& grid = problem.plate.grid;
        const int        node = int(largestNode);
        return {node / grid.nodesZ() * grid.spacingX, node % grid.nodesZ() * grid.spacingZ};
    }
};

/// Solves with a line of progress; the reference solver draws its own.
PlateSolution solvedWithProgress(PlateSolver& solver, const PlateProblem& problem, double tolerance)
{
    Progress progress("solving " + std::to_string(problem.plate.grid.nodes()) + " nodes on " + solver.name());
    if (solver.name() != PlateSolver::kReference) progress.mayLast();
    return solver.solve(problem.plate, problem.nodalForce, tolerance);
}

Solved solved(const SolveOptions& options)
{
    Solved s{readProblem(options.problem, options.cells), {}, {}};
    for (const std::filesystem::path& file : s.problem.files) refuseSourceAsTarget("--out", file.string(), options.out);

    PlateSolver solver = options.solver.open();
    const auto  told   = solver.counts().takeovers;
    s.solution         = solvedWithProgress(solver, s.problem, options.solver.tolerance);
    s.note             = solver.note();
    sayTakeover(solver.takeoverSince(told));
    if (const SolveReport& report = s.solution.report; !report.converged)
        s.problem.warnings.push_back(
            "the solution misses --tolerance: " + errorText(report) + "; try fewer cells" +
            (report.solver == PlateSolver::kReference ? " or less contrast" : ", less contrast or --solver reference"));
    warn(s.problem.warnings);
    // With one plate and one load, the time of the answer includes the preparation.
    s.solution.report.milliseconds += s.solution.report.setUpMilliseconds;

    for (const Probe& probe : s.problem.probes)
        s.probeDeflections.push_back(interpolate(s.problem.plate.grid, s.solution.deflection, probe.x, probe.z));
    const std::vector<double>& w = s.solution.deflection.values();
    for (std::size_t node = 0; node < w.size(); ++node)
        if (std::abs(w[node]) > std::abs(w[s.largestNode])) s.largestNode = node;
    return s;
}

template <class T>
nlohmann::ordered_json orNull(const std::optional<T>& value)
{
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

bool hasSquareCells(const PlateGrid& grid)
{
    constexpr double kRounding = 1e-9; // relative, above the rounding of size / cells [1]
    return std::abs(grid.spacingX - grid.spacingZ) <= kRounding * grid.spacingX;
}

/// Returns the sum of all forces [N].
double totalForce(const PlateProblem& problem)
{
    return std::accumulate(problem.nodalForce.values().begin(), problem.nodalForce.values().end(), 0.0);
}

/// Returns the least and the largest foundation [Pa/m].
std::pair<double, double> foundationRange(const Plate& plate)
{
    if (plate.foundationShape.values().empty()) return {plate.foundation, plate.foundation};
    const auto [least, most] = std::ranges::minmax(plate.foundationShape.values());
    return {plate.foundation * least, plate.foundation * most};
}

nlohmann::ordered_json plateJson(const Plate& plate)
{
    const PlateGrid& grid          = plate.grid;
    const auto& [x0, x1, z0, z1]   = plate.edges;
    const auto [softest, stiffest] = std::ranges::minmax(plate.rigidity.values());
    const auto [loosest, firmest]  = foundationRange(plate);
    return {{"size", {grid.sizeX(), grid.sizeZ()}},
            {"cells", {grid.cellsX, grid.cellsZ}},
            {"spacing", {grid.spacingX, grid.spacingZ}},
            {"square_cells", hasSquareCells(grid)},
            {"poisson", plate.poissonRatio},
            {"edges", {{"x0", name(x0)}, {"x1", name(x1)}, {"z0", name(z0)}, {"z1", name(z1)}}},
            {"foundation", firmest}, // the largest
            {"foundation_min", loosest},
            {"rigidity_min", softest},
            {"rigidity_max", stiffest}};
}

void printJson(const Solved& s)
{
    const SolveReport&     report = s.solution.report;
    const Probe            place  = s.largestPlace();
    nlohmann::ordered_json probes = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < s.problem.probes.size(); ++k)
        probes.push_back(
            {{"x", s.problem.probes[k].x}, {"z", s.problem.probes[k].z}, {"deflection", s.probeDeflections[k]}});
    const nlohmann::ordered_json answer{
        {"plate", plateJson(s.problem.plate)},
        {"total_force", totalForce(s.problem)},
        {"probes", probes},
        {"max_deflection", s.largest()},
        {"max_deflection_at", {place.x, place.z}},
        {"report",
         {{"solver", report.solver},
          {"note", s.note.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(s.note)},
          {"iterations", orNull(report.iterations)},
          {"error_estimate", orNull(report.errorEstimate)},
          {"converged", report.converged},
          {"work_units", orNull(report.workUnits)},
          {"milliseconds", report.milliseconds},
          {"processor_milliseconds", orNull(report.processorMilliseconds)}}},
        {"warnings", s.problem.warnings}};
    std::cout << jsonText(answer);
}

void printText(const Solved& s, const std::string& name)
{
    const Plate&     plate         = s.problem.plate;
    const PlateGrid& grid          = plate.grid;
    const auto& [x0, x1, z0, z1]   = plate.edges;
    const auto [softest, stiffest] = std::ranges::minmax(plate.rigidity.values());
    const Probe place              = s.largestPlace();

    std::printf("%s\n", name.c_str());
    std::printf("  plate       %s x %s, %d x %d cells of %s x %s%s, Poisson's ratio %g\n",
                formatQuantity(grid.sizeX(), "m").c_str(), formatQuantity(grid.sizeZ(), "m").c_str(), grid.cellsX,
                grid.cellsZ, formatQuantity(grid.spacingX, "m").c_str(), formatQuantity(grid.spacingZ, "m").c_str(),
                hasSquareCells(grid) ? "" : " (cells are not square)", plate.poissonRatio);
    std::printf("  edges       x0 %s, x1 %s, z0 %s, z1 %s\n", palp::name(x0), palp::name(x1), palp::name(z0),
                palp::name(z1));
    std::printf("  rigidity    %s to %s\n", formatQuantity(softest, "N m").c_str(),
                formatQuantity(stiffest, "N m").c_str());
    if (const auto [least, most] = foundationRange(plate); most > 0)
        std::printf("  foundation  %s%s\n", least < most ? (formatQuantity(least, "Pa/m") + " to ").c_str() : "",
                    formatQuantity(most, "Pa/m").c_str());
    std::printf("  load        %s in all\n", formatQuantity(totalForce(s.problem), "N").c_str());
    std::printf("  deflection  largest %s, at x %s, z %s\n", formatQuantity(s.largest(), "m").c_str(),
                formatQuantity(place.x, "m").c_str(), formatQuantity(place.z, "m").c_str());
    std::printf("  solver      %s, %.0f ms", s.solution.report.solver.c_str(), s.solution.report.milliseconds);
    if (s.solution.report.errorEstimate) std::printf(", error about %.1e", *s.solution.report.errorEstimate);
    if (s.solution.report.iterations)
        std::printf(", %d steps, %.0f work units", *s.solution.report.iterations,
                    s.solution.report.workUnits.value_or(0));
    std::printf("\n");
    if (!s.problem.probes.empty()) std::printf("\n  %12s %12s %16s\n", "x [m]", "z [m]", "deflection [m]");
    for (std::size_t k = 0; k < s.problem.probes.size(); ++k)
        std::printf("  %12.6g %12.6g %16.8e\n", s.problem.probes[k].x, s.problem.probes[k].z, s.probeDeflections[k]);
}

void solveAndPrint(const SolveOptions& options)
{
    if (!options.out.empty() && std::filesystem::path(options.out).extension() != ".npy")
        throw Error("--out: expected a name that ends with .npy, found \"" + options.out + "\"");
    if (!options.out.empty()) expectWritable(options.out);
    const Solved s = solved(options);
    if (!options.out.empty()) writeNpy(options.out, s.solution.deflection);
    if (options.json)
        printJson(s);
    else
        printText(s, options.problem);
}

} // namespace

void addSolveCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("solve", "computes the deflection of one plate from a problem file");
    const auto options = std::make_shared<SolveOptions>();
    command->add_option("PROBLEM", options->problem, "problem file (JSON, SI units)")->required();
    command->add_option(
        "--cells", options->cells,
        "number of cells along x, with those along z in proportion (at least 4; the reference solver takes up to "
        "1050625 nodes in all, such as 1024 x 1024 cells)");
    options->solver.addTo(*command);
    command->add_flag("--json", options->json,
                      "machine-readable, full precision; max_deflection is the deflection of "
                      "largest magnitude, with its sign");
    command->add_option("--out", options->out, "a .npy file for the deflection [m] at the nodes");
    command->footer(
        "A problem file (rigidity in N m, force in N, pressure in Pa, lengths in m):\n"
        "  {\"size\": [1, 1.5], \"cells\": [64, 96], \"poisson\": 0.3,\n"
        "   \"edges\": {\"x0\": \"clamped\", \"x1\": \"free\", \"z0\": \"supported\", \"z1\": \"clamped\"},\n"
        "   \"rigidity\": {\"law\": \"linear\", \"from\": 1, \"to\": 10, \"axis\": \"z\"},\n"
        "   \"load\": {\"law\": \"point\", \"force\": 1, \"at\": [0.5, 0.75]},\n"
        "   \"probes\": [[0.25, 0.25]]}\n"
        "Edges that are not named are clamped; foundation [Pa/m], a number or a law, and probes may be omitted.\n"
        "Rigidity laws and their keys (points are [x, z]):\n"
        "  constant                         value\n"
        "  linear, hyperbolic, exponential  from, to, and axis (x or z; x if absent) or start, end\n"
        "  gaussian                         from, to, centre or centres, sigma\n"
        "  disc                             from, to, centre or centres, radius\n"
        "  box                              from, to, low, high\n"
        "  checker                          from, to, edge\n"
        "  grid                             file\n"
        "Load laws and their keys:\n"
        "  point     force, at\n"
        "  uniform   pressure\n"
        "  gaussian  force, centre, sigma\n"
        "  grid      file (pressures)\n"
        "A grid names a .npy file of values at the nodes, of shape (cells_x + 1, cells_z + 1).\n\n"
        "Examples:\n"
        "  palpate solve plate.json\n"
        "  palpate solve plate.json --cells 256 --solver host --tolerance 1e-6 --json\n"
        "  palpate solve plate.json --out deflection.npy");
    command->callback([options] { solveAndPrint(*options); });
}

} // namespace palp
