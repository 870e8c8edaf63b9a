#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/compute/command_list.h"
#include "engine/compute/context.h"
#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/progress.h"
#include "engine/plate/load.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/tools/bench/accuracy.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/plot/line_plot.h"

namespace palp {
namespace {

struct BenchOptions {
    std::vector<std::string> devices  = {"auto", "reference"};
    std::vector<int>         nodes    = {65, 129, 257};
    std::vector<int>         loads    = {1};
    std::string              schedule = "automatic";
    std::string              law      = "linear";
    double                   contrast = 10, tolerance = 1e-4;
    int                      repeats = 21;
    std::string              out;
    bool                     json = false;
};

/// One line of the table; times are wall times, of preparation once and of solves at two quantiles.
struct Row {
    std::string           device;
    int                   nodes = 0, loads = 0;
    double                prepare = 0, coldMedian = 0, coldTail = 0; ///< [ms] 50th and 99th percentile
    std::optional<double> warmMedian, deviceMedian;                  ///< [ms]
    std::optional<double> updateMedian;                              ///< [ms] see update()
    SolveReport           report;                                    ///< of the last cold solve
    std::optional<double> error;                                     ///< largest, over the largest deflection [1]
    std::optional<double> traffic, copy;                             ///< [GB/s] see kBytesPerNode
    std::optional<int>    dispatchesPerCycle;                        ///< [1]
};

/// What an application of the operator must move at least: deflection, rigidity, force and divisor in, deflection out.
constexpr double kBytesPerNode = 5 * sizeof(float); // [byte]

/// Beyond this the reference takes seconds for the true error.
constexpr int kMostNodesForError = 257; // [1] a side

double quantile(std::vector<double> values, double q)
{
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, std::size_t(q * double(values.size())))];
}

double rigidityAt(const BenchOptions& o, double x, double z)
{
    return bench::rigidityAt(o.law, o.contrast, x, z);
}

Schedule scheduleNamed(const std::string& name)
{
    const std::string word = CLI::ignore_case(name);
    if (word == "automatic") return Schedule::automatic;
    if (word == "pass-by-pass") return Schedule::passByPass;
    if (word == "fused") return Schedule::fused;
    throw Error("--schedule: expected automatic, pass-by-pass or fused, found \"" + name + "\"");
}

Plate plateOf(const BenchOptions& o, int nodes)
{
    return bench::plateOf(o.law, o.contrast, nodes);
}

/// Fingertips of 4 mm, or 1.5 spacings on a very coarse grid, each a little beside the last, as a batch for the force
/// between two updates has.
std::vector<NodeField> fingertips(const PlateGrid& grid, int count)
{
    const int              side   = int(std::ceil(std::sqrt(count)));
    const double           radius = std::max(4e-3, 1.5 * grid.spacingX);
    std::vector<NodeField> loads;
    for (int n = 0; n < count; ++n) {
        const double x = 1e-3 * (n / side - (side - 1) / 2.0), z = 1e-3 * (n % side - (side - 1) / 2.0);
        loads.push_back(footprintLoad(grid, 1, grid.sizeX() / 2 + x, grid.sizeZ() / 2 + z, radius));
    }
    return loads;
}

/// How fast the device copies its own memory, reading and writing counted [GB/s]; empty without a clock.
std::optional<double> copyBandwidth(compute::Context& context)
{
    constexpr std::size_t kBytes  = 64 << 20; // beyond most caches
    constexpr int         kCopies = 8;
    const compute::Buffer from(context, "copied", kBytes, compute::Intent::device),
        to(context, "copy", kBytes, compute::Intent::device);
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

class Stopwatch {
public:
    [[nodiscard]] double milliseconds() const
    {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Row measureReference(const BenchOptions& o, int nodes)
{
    const Plate                plate = plateOf(o, nodes);
    const NodeField            load  = fingertips(plate.grid, 1).front();
    const ReferencePlateSolver solver(plate);
    std::vector<double>        times;
    Row                        row;
    row.device  = "reference";
    row.nodes   = nodes;
    row.loads   = 1;
    row.prepare = solver.factoriseMilliseconds();
    for (int n = 0; n < o.repeats; ++n) {
        const Stopwatch watch;
        row.report = solver.solve(load).report;
        times.push_back(watch.milliseconds());
    }
    row.coldMedian = quantile(times, 0.5);
    row.coldTail   = quantile(times, 0.99);
    return row;
}

/// Points as a contact gathers them, some 3000, with their rigidities.
struct GatheredPoints {
    std::vector<ChartPoint> positions;
    std::vector<double>     rigidities;
    double                  spacing; ///< [m]

    GatheredPoints(const BenchOptions& o, const Plate& plate)
    {
        constexpr int kSide = 55;
        spacing             = plate.grid.sizeX() / kSide;
        for (int n = 0; n < kSide * kSide; ++n) {
            const double u = (n / kSide + 0.5 + 0.4 * std::sin(12.9 * n)) / kSide; // jitter that repeats
            const double v = (n % kSide + 0.5 + 0.4 * std::sin(78.2 * n)) / kSide;
            positions.push_back({u * plate.grid.sizeX(), v * plate.grid.sizeZ()});
            rigidities.push_back(bench::kSoftest * rigidityAt(o, u, v));
        }
    }
};

/// What a contact that moves on costs: points in, rigidity, solve from the last answer, deflection of the points out.
double update(MultigridPlateSolver& solver, const GatheredPoints& points, const std::vector<NodeField>& forces)
{
    const Stopwatch watch;
    solver.setRigidity({points.positions, points.rigidities, {0, 0}, points.spacing}, Resampling::logMean);
    (void)solver.solve(forces, MultigridPlateSolver::Start::warm);
    return watch.milliseconds();
}

Row measureMultigrid(const BenchOptions& o, compute::Context& context, const PlateKernels& kernels, int nodes,
                     int loads, std::optional<double> copy)
{
    const Plate                  plate  = plateOf(o, nodes);
    const std::vector<NodeField> forces = fingertips(plate.grid, loads);
    MultigridPlateSolver         solver(context, kernels, plate, {.tolerance = o.tolerance, .loads = loads});
    (void)solver.solve(forces); // drivers compile at the first dispatch
    (void)solver.solve(forces, MultigridPlateSolver::Start::warm);

    Row row;
    row.device = context.device().name;
    row.nodes  = nodes;
    row.loads  = loads;
    const Stopwatch preparation;
    solver.setRigidity(plate.rigidity);
    row.prepare = preparation.milliseconds();
    std::vector<double> cold, warm, device;
    NodeField           answer;
    for (int n = 0; n < o.repeats; ++n) {
        const Stopwatch watch;
        auto            solutions = solver.solve(forces);
        cold.push_back(watch.milliseconds());
        row.report = solutions.front().report;
        if (row.report.deviceMilliseconds) device.push_back(*row.report.deviceMilliseconds);
        answer = std::move(solutions.front().deflection);
        const Stopwatch again;
        (void)solver.solve(forces, MultigridPlateSolver::Start::warm);
        warm.push_back(again.milliseconds());
    }
    const GatheredPoints points(o, plate);
    std::vector<double>  updates;
    (void)update(solver, points, forces);
    for (int n = 0; n < o.repeats; ++n) updates.push_back(update(solver, points, forces));
    row.coldMedian   = quantile(cold, 0.5);
    row.coldTail     = quantile(cold, 0.99);
    row.warmMedian   = quantile(warm, 0.5);
    row.updateMedian = quantile(updates, 0.5);
    if (!device.empty()) {
        row.deviceMedian = quantile(device, 0.5);
        row.traffic =
            *row.report.workUnits * double(plate.grid.nodes()) * loads * kBytesPerNode / *row.deviceMedian / 1e6;
    }
    row.copy               = copy;
    row.dispatchesPerCycle = solver.dispatchesPerCycle();
    if (nodes <= kMostNodesForError)
        row.error = bench::errorOf(answer, ReferencePlateSolver(plate).solve(forces.front()).deflection);
    return row;
}

std::vector<Row> measure(const BenchOptions& o)
{
    std::vector<Row> rows;
    Progress         progress("measuring");
    for (const std::string& name : o.devices) {
        if (compute::isProcessorWord(name, PlateSolver::kReference)) {
            for (int nodes : o.nodes) rows.push_back(measureReference(o, nodes));
            continue;
        }
        compute::Context context =
            orTheReference([&] { return compute::Context(compute::ContextSettings{.device = name}); });
        sayPassedOver(context.device().name, context.note());
        const PlateKernels kernels(context, scheduleNamed(o.schedule));
        const auto         copy = copyBandwidth(context);
        for (int nodes : o.nodes)
            for (int loads : o.loads) rows.push_back(measureMultigrid(o, context, kernels, nodes, loads, copy));
    }
    return rows;
}

template <class T>
nlohmann::ordered_json orNull(const std::optional<T>& value)
{
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json jsonOf(const BenchOptions& o, const std::vector<Row>& rows)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Row& r : rows)
        list.push_back({{"device", r.device},
                        {"nodes", r.nodes},
                        {"loads", r.loads},
                        {"prepare_ms", r.prepare},
                        {"cold_p50_ms", r.coldMedian},
                        {"cold_p99_ms", r.coldTail},
                        {"cold_p50_ms_per_load", r.coldMedian / r.loads},
                        {"warm_p50_ms", orNull(r.warmMedian)},
                        {"update_p50_ms", orNull(r.updateMedian)},
                        {"device_p50_ms", orNull(r.deviceMedian)},
                        {"iterations", orNull(r.report.iterations)},
                        {"work_units", orNull(r.report.workUnits)},
                        {"error_estimate", orNull(r.report.errorEstimate)},
                        {"error", orNull(r.error)},
                        {"least_traffic_gb_per_s", orNull(r.traffic)},
                        {"copy_gb_per_s", orNull(r.copy)},
                        {"dispatches_per_cycle", orNull(r.dispatchesPerCycle)}});
    return {
        {"law", o.law}, {"contrast", o.contrast}, {"tolerance", o.tolerance}, {"repeats", o.repeats}, {"rows", list}};
}

/// "-" where there is no number.
std::string cell(const std::optional<double>& value, const char* format)
{
    if (!value) return "-";
    char text[32];
    std::snprintf(text, sizeof text, format, *value);
    return text;
}

void printTable(const BenchOptions& o, const std::vector<Row>& rows)
{
    std::printf("clamped plate, %s rigidity of contrast %g, tolerance %g, %d repeats; times in ms\n", o.law.c_str(),
                o.contrast, o.tolerance, o.repeats);
    std::printf("%-20s %5s %5s %8s %8s %8s %8s %8s %8s %5s %10s %5s %8s %8s %13s\n", "device", "nodes", "loads",
                "prepare", "cold p50", "cold p99", "per load", "warm p50", "update", "steps", "dispatches", "work",
                "estimate", "error", "GB/s of copy");
    for (const Row& r : rows)
        std::printf("%-20.20s %5d %5d %8.2f %8.2f %8.2f %8.2f %8s %8s %5s %10s %5s %8s %8s %6s/%6s\n", r.device.c_str(),
                    r.nodes, r.loads, r.prepare, r.coldMedian, r.coldTail, r.coldMedian / r.loads,
                    cell(r.warmMedian, "%.2f").c_str(), cell(r.updateMedian, "%.2f").c_str(),
                    r.report.iterations ? std::to_string(*r.report.iterations).c_str() : "-",
                    r.dispatchesPerCycle ? std::to_string(*r.dispatchesPerCycle).c_str() : "-",
                    cell(r.report.workUnits, "%.0f").c_str(), cell(r.report.errorEstimate, "%.1e").c_str(),
                    cell(r.error, "%.1e").c_str(), cell(r.traffic, "%.2f").c_str(), cell(r.copy, "%.1f").c_str());
}

/// Time of preparation and cold solve against the size of the grid, a line per device and number of loads.
std::string plotOf(const BenchOptions& o, const std::vector<Row>& rows)
{
    std::vector<PlotSeries> series;
    for (const Row& r : rows) {
        const std::string name = r.device + (r.loads > 1 ? ", " + std::to_string(r.loads) + " loads" : "");
        auto at = std::find_if(series.begin(), series.end(), [&](const PlotSeries& s) { return s.name == name; });
        if (at == series.end()) at = series.insert(series.end(), PlotSeries{name, {}, {}, SeriesStyle::lineAndMarkers});
        at->x.push_back(r.nodes);
        at->y.push_back((r.prepare + r.coldMedian) / 1e3);
    }
    LinePlotSettings plot;
    plot.title = "From a rigidity to its deflection, " + o.law + " rigidity";
    plot.x     = {"nodes a side", "", Scale::logarithmic, {}};
    plot.y     = {"median time", "s", Scale::logarithmic, {}};
    return linePlotSvg(series, plot);
}

void check(const BenchOptions& o)
{
    for (int nodes : o.nodes)
        if (nodes < 9 || nodes > 2049)
            throw Error("--nodes: expected 9 to 2049 nodes a side, found " + std::to_string(nodes));
    for (int loads : o.loads)
        if (loads < 1 || loads > 256) throw Error("--loads: expected 1 to 256, found " + std::to_string(loads));
    if (o.repeats < 1 || o.repeats > 10000)
        throw Error("--repeats: expected 1 to 10000, found " + std::to_string(o.repeats));
    if (!(o.contrast >= 1 && o.contrast <= 1e6))
        throw Error("--contrast: expected 1 to 1e6, found " + cell(o.contrast, "%g"));
    checkTolerance(o.tolerance);
    (void)scheduleNamed(o.schedule);
    (void)rigidityAt(o, 0, 0); // the name of the law
}

void benchSolve(const BenchOptions& o)
{
    check(o);
    const std::vector<Row> rows = measure(o);
    if (!o.out.empty()) {
        makeFolder(o.out);
        const std::filesystem::path folder = o.out;
        writeFileWhole(folder / "solve.json", [&](std::ostream& file) { file << jsonText(jsonOf(o, rows)); });
        writeFileWhole(folder / "solve.svg", [&](std::ostream& file) { file << plotOf(o, rows); });
    }
    if (o.json)
        std::cout << jsonText(jsonOf(o, rows));
    else
        printTable(o, rows);
}

} // namespace

void addBenchCommand(CLI::App& app)
{
    CLI::App* bench = app.add_subcommand("bench", "how fast this machine is");
    bench->require_subcommand(1);
    addBenchPlateCommand(*bench);
    CLI::App*  solve = bench->add_subcommand("solve", "time, iterations and error of the plate solvers, size by size");
    const auto o     = std::make_shared<BenchOptions>();
    solve->add_option("--device", o->devices, "devices to measure, as for the command solve; several by commas")
        ->delimiter(',')
        ->capture_default_str();
    solve->add_option("--nodes", o->nodes, "nodes a side of the square grids, 9 to 2049")
        ->delimiter(',')
        ->capture_default_str();
    solve->add_option("--loads", o->loads, "solved together in one batch (not by the reference)")
        ->delimiter(',')
        ->capture_default_str();
    solve
        ->add_option("--schedule", o->schedule,
                     "of the cycle's dispatches: automatic (fused on hardware), pass-by-pass or fused")
        ->capture_default_str();
    solve->add_option("--law", o->law, "of the rigidity: linear, hyperbolic, wart, disc or discs")
        ->capture_default_str();
    solve->add_option("--contrast", o->contrast, "stiffest over softest")->capture_default_str();
    solve->add_option("--tolerance", o->tolerance, "relative, in the energy norm")->capture_default_str();
    solve->add_option("--repeats", o->repeats, "solves per line")->capture_default_str();
    solve->add_option("--out", o->out, "folder for solve.json and solve.svg");
    solve->add_flag("--json", o->json, "machine-readable");
    bench->footer("Examples:\n"
                  "  palpate bench solve --help\n"
                  "  palpate bench solve --out bench");
    solve->footer(
        "\"dispatches\" are those of one cycle, which wait for each other; \"update\" is\n"
        "3000 points in, their rigidity at the nodes, a warm solve, and the points' deflections out, in one "
        "submission;\n"
        "\"error\" is against the reference solver on the same grid, up to 257 nodes a side; \"GB/s\" is what the\n"
        "counted work must move at least (20 bytes per node and work unit), beside the device's copies.\n"
        "Examples:\n"
        "  palpate bench solve --out bench\n"
        "  palpate bench solve --device host,lavapipe --nodes 65,129 --loads 1,9,25,49\n"
        "  palpate bench solve --law disc --contrast 1000 --tolerance 1e-6 --json");
    solve->callback([solve, o] {
        refuseEmptyValues(*solve);
        benchSolve(*o);
    });
}

} // namespace palp
