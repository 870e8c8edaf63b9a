#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "engine/compute/context.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/processor.h"
#include "engine/core/progress.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/bench_report.h"
#include "engine/tools/bench/dispatch_bench.h"
#include "engine/tools/bench/one_thread.h"
#include "engine/tools/bench/outside_peers.h"
#include "engine/tools/bench/plate_bench.h"
#include "engine/tools/bench/point_bench.h"
#include "engine/tools/bench/shell_bench.h"
#include "engine/tools/bench/table_bench.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/named_option.h"
#include "engine/tools/cli/solver_choice.h"

namespace palp {
namespace {

using namespace bench;

struct BenchOptions {
    bool                     quick = false, json = false;
    std::string              solver = "auto", schedule = name(Schedule::automatic), out;
    std::vector<std::string> cases, maps;
    std::vector<int>         nodes;
    int                      runs = 11;
};

constexpr int kFewestNodes = 33, kMostNodes = 1025; // on a side
constexpr int kFewestRuns = 11;                     // quartiles of fewer say little

std::vector<std::string> allCases()
{
    std::vector<std::string> names = plateCases();
    names.insert(names.end(), pointCases().begin(), pointCases().end());
    names.insert(names.end(), tableCases().begin(), tableCases().end());
    names.insert(names.end(), shellCases().begin(), shellCases().end());
    names.insert(names.end(), dispatchCases().begin(), dispatchCases().end());
    return names;
}

std::vector<std::string> allMaps()
{
    std::vector<std::string> names;
    for (const Map& map : maps()) names.emplace_back(map.name);
    return names;
}

void checkNames(const char* option, const std::vector<std::string>& names, const std::vector<std::string>& known)
{
    std::string list;
    for (const auto& name : known) list += (list.empty() ? "" : ", ") + name;
    for (const auto& name : names)
        if (std::ranges::find(known, name) == known.end())
            throw Error(std::string(option) + ": unknown name \"" + name + "\"; known: " + list);
}

Schedule scheduleOf(const BenchOptions& o)
{
    return optionNamed<Schedule>("--schedule", o.schedule);
}

void check(const BenchOptions& o)
{
    checkNames("--cases", o.cases, allCases());
    checkNames("--maps", o.maps, allMaps());
    (void)scheduleOf(o);
    for (const int nodes : o.nodes)
        if (nodes < kFewestNodes || nodes > kMostNodes || nodes % 4 != 1)
            throw Error("--nodes: expected " + std::to_string(kFewestNodes) + " to " + std::to_string(kMostNodes) +
                        " nodes a side, one more than a multiple of 4 (the error of the grid is found from one twice "
                        "as coarse), found " +
                        std::to_string(nodes));
    constexpr int kMostQuick = 257;
    for (const int nodes : o.nodes)
        if (o.quick && nodes > kMostQuick)
            throw Error("--nodes: with --quick at most " + std::to_string(kMostQuick) + ", found " +
                        std::to_string(nodes));
    if (o.runs < kFewestRuns || o.runs > 1000)
        throw Error("--runs: expected " + std::to_string(kFewestRuns) + " to 1000, found " + std::to_string(o.runs));
    if (compute::isProcessorWord(o.solver, PlateSolver::kReference))
        throw Error(
            "--solver: the reference is a direct solver like its peers; expected auto, host, lavapipe, an index "
            "or part of a name");
}

/// Starts again with one thread for each library, as the program that has the peers if it is beside this one.
void becomeBenchmark()
{
    const std::filesystem::path self  = runningProgram();
    const std::filesystem::path peers = self.parent_path() / "palpate_peers";
    std::error_code             error;
    becomeOneThread(!self.empty() && std::filesystem::exists(peers, error) ? peers : self);
}

// --- the command

BenchReport measure(const BenchOptions& o)
{
    BenchReport report;
    report.runs        = o.runs;
    report.quick       = o.quick;
    report.processor   = processorName();
    report.cholmod     = outsidePeers().cholmodNote;
    report.eigen       = eigenVersion();
    report.nanoflann   = outsidePeers().nanoflannNote;
    report.environment = oneThreadEnvironment();

    std::vector<std::string> cases = o.cases;
    if (cases.empty()) cases = o.quick ? plateCases() : allCases();
    if (o.quick && o.cases.empty()) std::erase(cases, "batch"); // it takes as long as all others together
    const auto wants = [&](const std::vector<std::string>& some) {
        return std::ranges::any_of(some,
                                   [&](const auto& name) { return std::ranges::find(cases, name) != cases.end(); });
    };

    Progress          progress("measuring");
    const OnStep      onStep = [&](std::size_t done, std::size_t total) { progress.at(done, total); };
    PlateBenchOptions plates{.cases = cases, .nodes = o.nodes, .maps = o.maps, .runs = o.runs};
    if (plates.nodes.empty())
        plates.nodes = o.quick ? std::vector<int>{33, 65, 129, 257} : std::vector<int>{33, 65, 129, 257, 513, 1025};
    if (o.quick) {
        plates.quick         = true;
        plates.patience      = 40; // what begins before then ends within 50 s
        plates.mostEigen     = 129;
        plates.jacobiSeconds = 3;
        plates.mostMemory    = 257;
    }
    {
        compute::Context context(compute::ContextSettings{.processor = o.solver});
        sayPassedOver(context.processor().name, context.note());
        report.solver = context.processor().name;
        report.clock  = clockOf(context);
        if (wants(plateCases())) {
            const PlateKernels kernels(context, scheduleOf(o));
            report.rows = measurePlates(context, kernels, plates, onStep);
        }
        if (wants(dispatchCases()))
            for (BenchRow& row : countDispatches(context, scheduleOf(o), plates.nodes))
                report.rows.push_back(std::move(row));
    }
    if (wants(pointCases())) {
        const std::vector<int> nodes = o.nodes.empty() ? std::vector<int>{65, 129, 257} : o.nodes;
        for (BenchRow& row : measurePoints(cases, o.solver, nodes, o.runs, onStep))
            report.rows.push_back(std::move(row));
    }
    const std::vector<int> ofTables = o.nodes.empty() ? std::vector<int>{65, 129} : o.nodes;
    if (wants(tableCases()))
        for (BenchRow& row : measureTables(o.solver, ofTables, o.maps, o.runs, onStep))
            report.rows.push_back(std::move(row));
    if (wants(shellCases()))
        for (BenchRow& row : measureShells(o.solver, ofTables, o.maps, o.runs, onStep))
            report.rows.push_back(std::move(row));
    return report;
}

void runBench(const BenchOptions& o)
{
    check(o);
    becomeBenchmark();
    const BenchReport report = measure(o);
    if (report.rows.empty())
        throw Error(
            "--nodes, --maps: nothing to measure: new_map, new_load and contrast begin at 65 nodes, new_load is for "
            "smooth maps, update, table and shell are for 65 to 129 nodes");
    if (!o.out.empty()) {
        makeFolder(o.out);
        const std::filesystem::path folder = o.out;
        const auto                  write  = [&](const char* name, const std::string& text) {
            writeFileWhole(folder / name, [&](std::ostream& file) { file << text; });
        };
        write("plate.json", jsonOf(report));
        writeFileWhole(folder / "plate.txt", [&](std::ostream& file) { printText(file, report); });
        for (const auto& [kind, map] :
             {std::pair("new_map", "linear"), {"new_load", "linear"}, {"contrast", "disc_100"}})
            if (std::ranges::any_of(report.rows, [&, kind = kind, map = map](const BenchRow& row) {
                    return row.kind == kind && row.map == map;
                }))
                write((std::string(kind) + ".svg").c_str(), plotOf(report, kind, map));
    }
    if (o.json)
        std::cout << jsonOf(report);
    else
        printText(std::cout, report);
}

} // namespace

void addBenchCommand(CLI::App& app)
{
    CLI::App*  bench = app.add_subcommand("bench", "times the plate's solver and its alternatives");
    const auto o     = std::make_shared<BenchOptions>();
    bench->add_flag("--quick", o->quick, "measures only plates of up to 257 nodes a side, in less than a minute");
    bench->add_option("--solver", o->solver, "where Palpate computes, as in palpate solve")->capture_default_str();
    bench
        ->add_option(
            "--cases", o->cases,
            "what to measure, separated by commas: new_map, new_load, contrast, jacobi, memory, batch, update, gather, "
            "grid_map, table, shell, dispatches [all]")
        ->delimiter(',');
    bench
        ->add_option("--nodes", o->nodes, "nodes a side of the square grids, 33 to 1025, one more than a multiple of 4")
        ->delimiter(',');
    bench
        ->add_option("--maps", o->maps,
                     "rigidities of new_map, new_load, contrast, table and shell, separated by commas: linear, "
                     "hyperbolic, wart, "
                     "disc_100, disc_0.1, disc_1000, disc_1e5, discs [all; of table and shell linear, wart, disc_100]")
        ->delimiter(',');
    bench
        ->add_option("--schedule", o->schedule,
                     "how a cycle is divided into dispatches; automatic is fused on hardware: " + wordsOf<Schedule>())
        ->capture_default_str();
    bench->add_option("--runs", o->runs, "timed turns of each measurement, at least 11")->capture_default_str();
    bench->add_option("--out", o->out, "folder for plate.json, plate.txt and pictures of the curves");
    bench->add_flag("--json", o->json, "machine-readable");
    bench->footer(
        "Times are processor time of one thread: medians and quartiles of alternating turns of peer and Palpate.\n"
        "\"error\" is the largest error over the largest deflection, against a refined solution on the same grid;\n"
        "\"discretisation\" asks for an error below the grid's own. The peers CHOLMOD (libsuitesparse-dev) and\n"
        "nanoflann (libnanoflann-dev) are measured if the program palpate_peers is beside this one; it is built with\n"
        "-DPALPATE_BENCH_PEERS=ON. engine/performance.md explains the results.\n"
        "Examples:\n"
        "  palpate bench --quick\n"
        "  palpate bench --out bench\n"
        "  palpate bench --cases new_map,new_load --nodes 129,257 --json");
    bench->callback([o] {
        demandFolder("--out", o->out);
        runBench(*o);
    });
}

} // namespace palp
