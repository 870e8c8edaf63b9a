// The behaviour of the published iteration: undamped Jacobi, stopped when the change from sweep to sweep is small.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "engine/core/quantity.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/tools/bench/accuracy.h"
#include "engine/tools/bench/bench_plates.h"
#include "engine/tools/bench/damped_jacobi.h"
#include "engine/tools/paper/parts.h"
#include "engine/tools/plot/heat_map.h"
#include "engine/tools/plot/line_plot.h"

namespace palp::report {
namespace {

constexpr double kUndamped = 1, kDamped = 0.6;        ///< the paper's factor, and one that converges [1]
constexpr double kRules[] = {1e-3, 1e-4, 1e-5, 1e-6}; ///< changes at which one might stop, relative [1]
constexpr double kShown   = 1e-4;                     ///< the one of them that is shown

/// A clamped plate under a fingertip, and its answer.
struct Problem {
    explicit Problem(int nodes)
        : plate(bench::plateOf("linear", 10, nodes)), force(bench::fingertip(plate.grid)),
          truth(ReferencePlateSolver(plate).solve(force).deflection)
    {
    }
    Plate     plate;
    NodeField force; ///< [N]
    NodeField truth; ///< [m]
};

/// An iteration seen at some of its sweeps.
struct Course {
    double              omega = 1;
    int                 nodes = 0;             ///< a side
    std::vector<double> sweeps, change, error; ///< relative to the largest deflection, of the iterate and of the truth

    /// Returns the first of the recorded sweeps at which the change is below the rule.
    [[nodiscard]] std::optional<std::size_t> stop(double rule) const
    {
        for (std::size_t n = 0; n < change.size(); ++n)
            if (change[n] < rule) return n;
        return {};
    }
};

/// Records every sweep at first, later after every fiftieth part of the sweeps made.
/// \param onSweeps  is called with the number of sweeps made
Course courseOf(int nodes, double omega, int sweeps, const std::function<void(int)>& onSweeps)
{
    const Problem       problem(nodes);
    bench::DampedJacobi jacobi(problem.plate, problem.force, omega);
    Course              course{omega, nodes, {}, {}, {}};
    for (int done = 0; done < sweeps;) {
        const int skipped = done / 50;
        jacobi.sweep(skipped);
        const NodeField before = jacobi.answer();
        jacobi.sweep(1);
        done += skipped + 1;
        onSweeps(done);
        const NodeField w = jacobi.answer();
        course.sweeps.push_back(done);
        course.change.push_back(bench::errorOf(before, w));
        course.error.push_back(bench::errorOf(w, problem.truth));
    }
    return course;
}

std::string fieldSvg(const Problem& problem, const NodeField& w, const std::string& title, double deepest)
{
    HeatMapSettings settings;
    settings.title        = title;
    settings.grid         = problem.plate.grid;
    settings.markExtremes = false;
    if (deepest > 0) settings.range = ValueRange{0, deepest};
    return heatMapSvg(w, settings);
}

/// Draws the fields that the iterations leave on the plate, beside the answer.
void addFields(Section& section, int nodes, const Course& damped)
{
    constexpr int kGrown = 30; // undamped sweeps; by then only the fastest oscillation is visible
    const auto    stop   = damped.stop(kShown);
    const Problem problem(nodes);
    const double  deepest = *std::max_element(problem.truth.values().begin(), problem.truth.values().end());
    const auto    after   = [&](double omega, int sweeps) {
        bench::DampedJacobi jacobi(problem.plate, problem.force, omega);
        jacobi.sweep(sweeps);
        return jacobi.answer();
    };
    section.figures.push_back({"The answer.", fieldSvg(problem, problem.truth, "Direct solution", deepest)});
    if (stop) {
        const int sweeps = int(damped.sweeps[*stop]);
        section.figures.push_back(
            {"Damped, when the change falls below " + formatNumber(kShown) + ": in the colours of the answer.",
             fieldSvg(problem, after(kDamped, sweeps), "Damped, stopped after " + std::to_string(sweeps) + " sweeps",
                      deepest)});
    }
    section.figures.push_back(
        {"Undamped: what grows is the finest checker that the grid can show.",
         fieldSvg(problem, after(kUndamped, kGrown), "Undamped, after " + std::to_string(kGrown) + " sweeps", 0)});
}

std::string figureOf(const std::vector<Course>& all)
{
    std::vector<PlotSeries> plot;
    for (const Course& course : all) {
        const std::string who =
            (course.omega < 1 ? "damped, " : "undamped, ") + std::to_string(course.nodes) + " nodes";
        plot.push_back({who + ": error", course.sweeps, course.error, SeriesStyle::lineAndMarkers});
        if (course.omega < 1)
            plot.push_back({who + ": change", course.sweeps, course.change, SeriesStyle::lineAndMarkers});
    }
    LinePlotSettings settings;
    settings.title = "Jacobi's iteration: what the change says and what the error is";
    settings.x     = {"sweeps", "", Scale::logarithmic, {}};
    settings.y     = {"relative to the deflection", "", Scale::logarithmic, ValueRange{1e-7, 1e6}};
    return linePlotSvg(plot, settings);
}

} // namespace

Section jacobiPart(const ReportRun& run)
{
    const std::vector<int> nodes           = run.quick ? std::vector{17, 33} : std::vector{33, 65};
    const int              sweeps          = run.quick ? 20'000 : 1'000'000;
    constexpr int          kUndampedSweeps = 60; // by then the answer is 10^20 times too large
    std::vector<Course>    all;
    const auto             watched = [&](int side, double omega, int most) {
        const std::size_t before = all.size();
        all.push_back(courseOf(side, omega, most, [&](int done) {
            run.step(before * std::size_t(sweeps) + std::size_t(done), (nodes.size() + 1) * std::size_t(sweeps));
        }));
    };
    watched(nodes.front(), kUndamped, kUndampedSweeps);
    for (const int side : nodes) watched(side, kDamped, sweeps);

    Section       section{'e', "Jacobi's iteration and when to stop it", {}, {}, {}, {}, {}, {}};
    const Course& undamped = all.front();
    const double  growth   = std::pow(undamped.error.back() / undamped.error[undamped.error.size() / 2],
                                      1 / (undamped.sweeps.back() - undamped.sweeps[undamped.sweeps.size() / 2]));
    section.text = {"The paper iterates w ← w + (f - A w) / diagonal until the change is small. On the stencil of the "
                    "plate the fastest oscillation grows with every sweep. Damped by 0.6 it converges, but the slow, "
                    "smooth part of the answer changes by so little a sweep that the change is small long before the "
                    "error is. Clamped plate, rigidity linear with a contrast of 10, a fingertip in the middle."};
    section.numbers.push_back({"undamped/growth_per_sweep", "1", {growth}});
    Table table{"When the change falls below the rule, and how wrong the answer is then.",
                {"nodes a side", "rule: change below", "sweeps", "error then"},
                {}};
    for (const Course& course : all) {
        const std::string stem = (course.omega < 1 ? "damped/" : "undamped/") + std::to_string(course.nodes) + "/";
        section.numbers.push_back({stem + "sweeps", "1", course.sweeps});
        section.numbers.push_back({stem + "change", "1", course.change});
        section.numbers.push_back({stem + "error", "1", course.error});
        if (course.omega >= 1) continue;
        for (const double rule : kRules)
            if (const auto n = course.stop(rule)) {
                table.rows.push_back({std::to_string(course.nodes), formatNumber(rule), fixed(course.sweeps[*n], 0),
                                      percent(course.error[*n])});
                section.numbers.push_back({stem + "stop_" + formatNumber(rule) + "/sweeps", "1", {course.sweeps[*n]}});
                section.numbers.push_back({stem + "stop_" + formatNumber(rule) + "/error", "1", {course.error[*n]}});
            }
    }
    section.tables.push_back(std::move(table));
    section.figures.push_back({"Undamped, the error leaves the picture upwards. Damped, the change (which the rule "
                               "looks at) lies far below the error.",
                               figureOf(all)});
    addFields(section, nodes.back(), all.back());
    const auto stop = all.back().stop(kShown);
    section.claims.push_back(
        {"Jacobi's iteration, stopped when the change is small, solves the plate.",
         "Undamped it grows " + fixed(growth, 2) + " times a sweep. Damped by 0.6 and stopped at a change of " +
             formatNumber(kShown) + " it is " + (stop ? percent(all.back().error[*stop]) : "-") + " off at " +
             std::to_string(nodes.back()) + " nodes a side.",
         "the published iteration in double precision, errors against a direct solution", Verdict::fails,
         "As printed it diverges, because the largest eigenvalue of its iteration is above 1 on every grid; "
         "damped, the rule stops far too early. Ours stops "
         "by an estimate of the error."});
    return section;
}

} // namespace palp::report
