// A search for divergence: random maps of rigidity, every combination of clamped, supported and free sides, each answer
// beside a direct solution.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/core/quantity.h"
#include "engine/plate/load.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/tools/bench/accuracy.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/paper/random_maps.h"
#include "engine/tools/plot/line_plot.h"

namespace palp::report {
namespace {

constexpr double kSize = 40e-3, kSoftest = 2e-3, kFootprint = 4e-3; ///< of the plate [m], [N m], of the finger [m]
constexpr double kTolerance = 1e-4;                                 ///< the pipeline's own [1]

/// One random plate and the outcome of its solve.
struct Trial {
    MapKind   kind     = MapKind::smooth;
    double    contrast = 1; ///< [1]
    Plate     plate;
    NodeField load;
    int       iterations = 0;
    double    error      = 0;     ///< largest, against the direct solution [1]
    bool      finite     = false; ///< every number of the answer
    bool      converged  = false;
    bool      takenOver  = false; ///< multigrid gave up and the direct solver answered
};

/// Returns the n-th of the 81 combinations of clamped, supported and free sides.
PlateEdges edgesOf(int n)
{
    constexpr Edge kEdges[] = {Edge::clamped, Edge::supported, Edge::free};
    return {kEdges[n % 3], kEdges[n / 3 % 3], kEdges[n / 9 % 3], kEdges[n / 27 % 3]};
}

Trial trialOf(int n, int cells, Uniform& uniform)
{
    const PlateGrid grid{cells, cells, kSize / cells, kSize / cells};
    Trial           trial;
    trial.kind     = kMapKinds[std::size_t(n) % kMapKinds.size()];
    trial.contrast = std::pow(1000, uniform());
    trial.plate    = {grid, edgesOf(n % 81), 0.45, 0, randomMap(trial.kind, grid, trial.contrast, uniform)};
    for (double& d : trial.plate.rigidity.values()) d *= kSoftest;
    // Every other plate lies on a foundation, and so does any that would fall: eight lengths (D/k)^(1/4) across.
    const double length = kSize / 8, middle = kSoftest * std::sqrt(trial.contrast);
    if (uniform() < 0.5 || whyUnsolvable(trial.plate)) trial.plate.foundation = middle / std::pow(length, 4);
    const auto   place = [&] { return uniform(0.15 * kSize, 0.85 * kSize); };
    const double x = place(), z = place();
    trial.load = footprintLoad(grid, 1, x, z, std::max(kFootprint, 1.5 * grid.spacingX));
    return trial;
}

void solve(Trial& trial, PlateSolver& solver)
{
    const PlateSolution found = solver.solve(trial.plate, trial.load, kTolerance);
    const NodeField     truth = ReferencePlateSolver(trial.plate).solve(trial.load).deflection;
    const auto&         w     = found.deflection.values();
    trial.finite              = std::all_of(w.begin(), w.end(), [](double value) { return std::isfinite(value); });
    trial.converged           = found.report.converged;
    trial.takenOver           = found.report.solver != solver.name();
    trial.iterations          = found.report.iterations.value_or(0);
    trial.error               = bench::errorOf(found.deflection, truth);
    trial.plate               = {}; // a thousand of them would be some hundred megabytes
    trial.load                = {};
}

std::string scatter(const std::vector<Trial>& all, bool errors)
{
    std::vector<PlotSeries> plot;
    for (const MapKind kind : kMapKinds) {
        PlotSeries series{name(kind), {}, {}, SeriesStyle::markers};
        for (const Trial& trial : all)
            if (trial.kind == kind) {
                series.x.push_back(trial.contrast);
                series.y.push_back(errors ? trial.error : trial.iterations);
            }
        plot.push_back(std::move(series));
    }
    if (errors)
        plot.push_back({"asked for (in the energy)", {1, 1000}, {kTolerance, kTolerance}, SeriesStyle::reference});
    LinePlotSettings settings;
    settings.title = errors ? "Error of each answer" : "Steps to each answer";
    settings.x     = {"contrast of the rigidity", "", Scale::logarithmic, {}};
    settings.y     = errors ? PlotAxis{"largest error", "", Scale::logarithmic, {}}
                            : PlotAxis{"steps of conjugate gradients", "", Scale::linear, {}};
    return linePlotSvg(plot, settings);
}

struct Count {
    int    plates = 0, notFinite = 0, notConverged = 0, takenOver = 0, mostSteps = 0;
    double worst = 0; ///< error [1]

    void add(const Trial& trial)
    {
        ++plates;
        notFinite += !trial.finite;
        notConverged += !trial.converged;
        takenOver += trial.takenOver;
        mostSteps = std::max(mostSteps, trial.iterations);
        worst     = std::max(worst, trial.error);
    }
};

Table tableOf(const std::vector<Trial>& all, const Count& total)
{
    Table table{"Taken over: multigrid did not reach the tolerance and the direct solver answered, as it does in use.",
                {"rigidity", "plates", "not finite", "not converged", "taken over", "most steps", "largest error"},
                {}};
    const auto add = [&](const std::string& what, const Count& count) {
        table.rows.push_back({what, std::to_string(count.plates), std::to_string(count.notFinite),
                              std::to_string(count.notConverged), std::to_string(count.takenOver),
                              std::to_string(count.mostSteps), formatNumber(count.worst)});
    };
    for (const MapKind kind : kMapKinds) {
        Count count;
        for (const Trial& trial : all)
            if (trial.kind == kind) count.add(trial);
        add(name(kind), count);
    }
    add("all", total);
    return table;
}

} // namespace

Section stabilityPart(const ReportRun& run)
{
    const int          plates = run.quick ? 81 : 1000, cells = run.quick ? 32 : 64;
    constexpr int      kSeed = 20200525; // any number; this one is the day of the preprint
    Uniform            uniform(kSeed);
    std::vector<Trial> all;
    Count              total;
    for (int n = 0; n < plates; ++n) {
        run.step(std::size_t(n), std::size_t(plates));
        all.push_back(trialOf(n, cells, uniform));
        solve(all.back(), run.solver);
        total.add(all.back());
    }

    Section section{'d', "Stability over random maps of rigidity", {}, {}, {}, {}, {}, {}};
    section.text = {
        std::to_string(plates) + " plates of " + std::to_string(cells) + " × " + std::to_string(cells) +
        " cells, contrast 1 to 1000, evenly in its logarithm, with all 81 combinations of clamped, supported "
        "and free sides in turn, a finger anywhere, and on every other one an elastic foundation (and where "
        "the plate would fall without one). Each answer is compared with a direct solution in double "
        "precision. The energy form is symmetric and positive for every rigidity above zero, so nothing "
        "can diverge; the table tests that."};
    std::vector<double> contrast, kind, steps, error;
    for (const Trial& trial : all) {
        contrast.push_back(trial.contrast);
        kind.push_back(double(trial.kind));
        steps.push_back(trial.iterations);
        error.push_back(trial.error);
    }
    section.numbers = {{"plates", "1", {double(plates)}},
                       {"not_finite", "1", {double(total.notFinite)}},
                       {"not_converged", "1", {double(total.notConverged)}},
                       {"taken_over", "1", {double(total.takenOver)}},
                       {"most_steps", "1", {double(total.mostSteps)}},
                       {"largest_error", "1", {total.worst}},
                       {"contrast", "1", contrast},
                       {"kind", "1", kind},
                       {"steps", "1", steps},
                       {"error", "1", error}};
    section.tables.push_back(tableOf(all, total));
    section.figures.push_back({"One mark for each plate.", scatter(all, false)});
    section.figures.push_back({"Against the direct solution; the tolerance is one of the energy, of which the largest "
                               "error may be a little more or much less.",
                               scatter(all, true)});
    const int bad = total.notFinite + total.notConverged;
    section.claims.push_back(
        {"The plate equation of varying stiffness is solved by iteration.",
         std::to_string(bad) + " of " + std::to_string(plates) + " plates diverged; " +
             std::to_string(total.takenOver) + " needed the direct solver; largest error " + formatNumber(total.worst) +
             ".",
         "random maps, sides of three kinds, each beside a direct answer", bad == 0 ? Verdict::holds : Verdict::inPart,
         bad == 0 ? "Ours does, however rough the map. The published iteration diverges: see part e."
                  : "Some plates were not solved to the tolerance."});
    return section;
}

} // namespace palp::report
