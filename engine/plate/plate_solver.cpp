#include "engine/plate/plate_solver.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <list>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>

#include "engine/compute/context.h"
#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/core/quantity.h"
#include "engine/plate/curved_bending.h"
#include "engine/plate/detail/hard_plates.h"
#include "engine/plate/detail/memory_shortage.h"
#include "engine/plate/detail/rigidity_unit.h"
#include "engine/plate/load.h"
#include "engine/plate/multigrid/direct_plate.h"
#include "engine/plate/multigrid/direct_shell.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/plate/multigrid/multigrid_shell_solver.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "engine/plate/reference/reference_shell_solver.h"
#include "engine/plate/thrust.h"

namespace palp {
namespace {

/// Size beyond which factorising takes a minute and gigabytes: an answer that is reported as not converged is then
/// better.
bool fitsReference(const PlateGrid& grid)
{
    return grid.nodes() <= 513 * 513;
}

std::string stoppedAt(const SolveReport& report, double tolerance)
{
    if (std::isnan(*report.errorEstimate)) return "the multigrid solver did not converge"; // some shells
    if (*report.errorEstimate <= tolerance)
        return "to the multigrid solver the plate is held too softly: rounding may hide how it moves as a whole";
    return "the multigrid solver stopped at an error of about " + formatNumber(*report.errorEstimate);
}

constexpr std::size_t kMostKeptFactor = 257 * 257; ///< nodes of shells of which two factors are kept
constexpr std::size_t kMostKeptNodes  = 129 * 129; ///< of a shell whose solver's memory is kept: some 20 MB

/// Returns how far off an answer may be whose work is right to the tolerance: that is of the second order [1].
double looseFor(double tolerance)
{
    constexpr double kLoosest = 1e-2; // beyond it the estimate of the first steps is a guess
    return std::min(kLoosest, std::sqrt(tolerance));
}

/// What the thrusts of a shell take off its answers. Each is solved for alone, in doubles: what is left of a work may
/// be a fiftieth of it, and several loads together may stop after a step. Where what an answer leaves of its load does
/// much of a work along it, the solver was wrong about itself: its matrix is indefinite, and an estimate by energies
/// may miss what cancels (a strip was felt a third too soft, and called converged).
class ThrustAnswers {
public:
    ThrustAnswers(MultigridShellSolver& solver, const Shell& shell, double tolerance) : thrusts_(shell), shell_(shell)
    {
        for (const ShellLoad& load : thrusts_.loads()) {
            answers_.push_back(std::move(solver.solve({&load, 1}, tolerance).front()));
            if (!answers_.back().report.converged) failed_ = answers_.back().report;
            if (failed_) return;
        }
        const auto loads = thrusts_.loads();
        for (const ShellLoad& load : loads)
            for (const ShellAnswer& answer : answers_) ofLoads_.push_back(along(load, answer));
        for (std::size_t t = 0; t < loads.size(); ++t) {
            const ShellLoad left = leftOf(shell, loads[t], answers_[t].deflection, answers_[t].stressFunction);
            const double    off  = std::abs(along(left, answers_[t]));
            const double    all  = std::abs(thrusts_.own(t, t) + ofLoads_[t * loads.size() + t]);
            if (off <= kMostOff * all) continue;
            failed_                = answers_[t].report;
            failed_->converged     = false;
            failed_->errorEstimate = off / all;
        }
    }

    /// Returns the share of the work that they leave [1].
    [[nodiscard]] double shareLeft(const ShellAnswer& answer, const Footprint& load) const
    {
        constexpr double kLeast = 1e-3;
        ShellAnswer      with   = answer;
        takeOff(with, load);
        return answer.work > 0 ? std::clamp(with.work / answer.work, kLeast, 1.0) : 1;
    }

    /// Takes them off the answer to a load.
    void takeOff(ShellAnswer& answer, const Footprint& load) const
    {
        if (failed_) answer.report = *failed_;
        if (failed_ || answers_.empty()) return;
        std::vector<double> right;
        for (const ShellAnswer& of : answers_) right.push_back(responseOf(load, of.deflection).work);
        const std::vector<double> y = thrusts_.numbers(ofLoads_, right);
        for (std::size_t t = 0; t < y.size(); ++t) {
            answer.work -= y[t] * right[t];
            const std::vector<double>& of = answers_[t].deflection.values();
            for (std::size_t n = 0; n < of.size(); ++n) answer.deflection.values()[n] -= y[t] * of[n];
            std::vector<double>& phi = answer.stressFunction.values(); // where it is wanted
            for (std::size_t n = 0; n < phi.size(); ++n)
                phi[n] += y[t] * (shell_.thrusts[t].values()[n] - answers_[t].stressFunction.values()[n]);
        }
    }

private:
    static constexpr double kMostOff = 3e-3; // of what a thrust meets: 7e-4 and less were seen [1]

    static double along(const ShellLoad& load, const ShellAnswer& answer)
    {
        return dot(load.onW, answer.deflection) + dot(load.onPhi, answer.stressFunction);
    }

    Thrusts                    thrusts_;
    const Shell&               shell_;
    std::vector<ShellAnswer>   answers_;
    std::vector<double>        ofLoads_;
    std::optional<SolveReport> failed_; ///< of a thrust that was not solved: then no answer is one
};

/// Solves for footprints on a shell by multigrid: the whole one to `drawn`, and the others so far that their works are
/// right to the tolerance.
FootprintSolution byMultigridOfShells(MultigridShellSolver& solver, const Shell& shell,
                                      std::span<const Footprint> loads, std::size_t whole, double tolerance,
                                      double drawn, Stresses stresses)
{
    const auto solveWhole = [&](double error) {
        if (stresses == Stresses::none) return std::move(solver.solve(loads.subspan(whole, 1), error).front());
        const NodeField load = loads[whole].load(shell.bending.grid);
        return std::move(solver.solve(std::span(&load, 1), error).front());
    };
    std::vector<Footprint> others;
    for (std::size_t n = 0; n < loads.size(); ++n)
        if (n != whole) others.push_back(loads[n]);
    const double        loose = looseFor(tolerance);
    const ThrustAnswers thrusts(solver, shell, tolerance);
    ShellAnswer         first = solveWhole(std::min(drawn, loose));
    // What thrust takes off a work leaves its error, and loads together may stop with three times the error of one.
    const double left = thrusts.shareLeft(first, loads[whole]), closer = left < 1 ? loose * std::sqrt(left) / 3 : loose;
    if (closer < std::min(drawn, loose)) first = solveWhole(closer);
    auto                rest = solver.solve(others, closer);
    const Shear         shear(shell);
    const CurvedBending curved(shell);
    FootprintSolution   solution;
    for (std::size_t n = 0; n < loads.size(); ++n) {
        ShellAnswer& of = n == whole ? first : rest[n < whole ? n : n - 1];
        thrusts.takeOff(of, loads[n]);
        solution.responses.push_back(responseOf(loads[n], of.deflection));
        solution.responses.back().work =
            of.work + shear.workOf(of.deflection) - squeezeWork(shell, of.deflection, loads[n]);
        solution.responses.back().curved = curved.workOf(of.deflection);
        if (!of.report.converged) solution.whole.report = of.report;
    }
    if (solution.whole.report.converged) solution.whole.report = first.report;
    solution.whole.deflection = std::move(first.deflection);
    if (stresses == Stresses::ofWhole) solution.stress = std::move(first.stressFunction);
    return solution;
}

/// Whether they differ in the values of their maps alone. Exactly: what a plate's answer is must not depend on the
/// plates that were solved before.
bool sameButRigidity(const Plate& a, const Plate& b)
{
    return a.grid == b.grid && a.edges == b.edges && a.poissonRatio == b.poissonRatio && a.foundation == b.foundation &&
           a.foundationShape.values().empty() == b.foundationShape.values().empty();
}

bool areAlike(const NodeField& a, const NodeField& b)
{
    return a.nodesX() == b.nodesX() && a.nodesZ() == b.nodesZ() && a.values() == b.values();
}

/// Whether they are the same to the last bit.
bool areAlike(const Shell& a, const Shell& b)
{
    const auto alike = [&](const NodeField Shell::*which) { return areAlike(a.*which, b.*which); };
    return sameButRigidity(a.bending, b.bending) && areAlike(a.bending.rigidity, b.bending.rigidity) &&
           areAlike(a.bending.foundationShape, b.bending.foundationShape) && a.stressEdges == b.stressEdges &&
           alike(&Shell::membraneCompliance) && alike(&Shell::curvatureX) && alike(&Shell::curvatureZ) &&
           alike(&Shell::curvatureXZ) && alike(&Shell::stressBed) && alike(&Shell::sheared) &&
           alike(&Shell::stretched) &&
           std::ranges::equal(a.thrusts, b.thrusts,
                              [](const NodeField& one, const NodeField& other) { return areAlike(one, other); });
}

/// Returns the report of all loads, or one of a load that did not converge.
const SolveReport& reportOf(const std::vector<PlateSolution>& solutions)
{
    const auto failed = std::ranges::find_if(solutions, [](const PlateSolution& s) { return !s.report.converged; });
    return failed == solutions.end() ? solutions.front().report : failed->report;
}

const SolveReport& reportOf(const FootprintSolution& solution)
{
    return solution.whole.report;
}

double wallMilliseconds()
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Returns whether the host may solve for the rims of this plate exactly, which gives other bits.
bool mayHaveRims(const Plate& plate)
{
    const Extremes of = extremesOf(plate.rigidity.values());
    return of.most > MultigridPlateSolver::kRimContrast * of.least;
}

/// Returns the median time of five calls, after one that is not timed [ms].
/// \param apart  from the end of a call to the next [s]
template <class Call>
double usualTime(const PlateSolver::Clock& clock, double apart, const Call& call)
{
    const auto now = [&] { return clock ? clock() : wallMilliseconds(); };
    call();
    std::array<double, 5> times;
    for (double& time : times) {
        std::this_thread::sleep_for(std::chrono::duration<double>(apart));
        const double began = now();
        call();
        time = now() - began;
    }
    std::ranges::nth_element(times, times.begin() + times.size() / 2);
    return times[times.size() / 2];
}

} // namespace

struct PlateSolver::Multigrid {
    /// A solver for one number of loads, and the plate that it was made for.
    struct Prepared {
        std::optional<MultigridPlateSolver> solver;
        Plate                               plate;
        double                              tolerance = 0;
        std::size_t                         loads     = 0; ///< that it takes together
        int                                 made      = 0; ///< solvers, up to now

        /// Makes the solver ready for a rigidity.
        /// \return milliseconds that it took
        double prepare(compute::Context& on, const PlateKernels& by, const Plate& wanted, std::size_t wantedLoads,
                       double wantedTolerance)
        {
            const auto     began = std::chrono::steady_clock::now();
            const Extremes of    = extremesOf(wanted.rigidity.values());
            if (solver && isUnitOf(solver->unitRigidity(), of) && sameButRigidity(plate, wanted) &&
                tolerance == wantedTolerance && loads == wantedLoads) {
                solver->setRigidity(wanted.rigidity, wanted.foundationShape);
            } else {
                solver.reset(); // its memory goes before the next one's comes
                solver.emplace(on, by, wanted,
                               MultigridPlateSolver::Settings{.tolerance = wantedTolerance, .loads = int(wantedLoads)});
                plate     = wanted;
                tolerance = wantedTolerance;
                loads     = wantedLoads;
                ++made;
            }
            return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
        }
    };

    /// A solver of eight loads at a time.
    struct Eights {
        Precision                   precision;
        std::optional<PlateKernels> kernels{}; ///< once they are needed
        Prepared                    prepared{};
    };

    /// A solver of a shell, and the shell that it was made ready for.
    struct PreparedShell {
        std::optional<MultigridShellSolver> solver;
        Shell                               shell;
    };

    compute::Context            context;
    bool                        likeTheHost; ///< smooths as the host does, and takes one load after the other
    PlateKernels                kernels;
    std::optional<ShellKernels> kernelsOfShells;   ///< once they are needed
    std::list<PreparedShell>    shells;            ///< the last ones of usual size, the newest first
    Prepared                    loads, footprints; ///< footprints: whose works are wanted alone
    Eights                      inFloats{Precision::floatGradients}, inDoubles{Precision::best};
    std::optional<DirectPlate>  direct; ///< once it pays
    int                         directsMade = 0;
    MemoryShortage              shortage; ///< of memory for fields of all loads together, in numbers of one

    Multigrid(const compute::ContextSettings& settings, SoftwareBits bits)
        : context(settings), likeTheHost(isHost() || (bits == SoftwareBits::ofTheHost &&
                                                      context.processor().kind == compute::ProcessorKind::software)),
          kernels(context, Schedule::automatic, Precision::best,
                  likeTheHost && !isHost() ? Smoother::chebyshev : Smoother::automatic)
    {
    }

    /// Returns why the host has to solve shells; empty: it need not, or this is the host.
    [[nodiscard]] std::string whyNoShells() const
    {
        if (isHost()) return {};
        if (likeTheHost) return context.processor().name + " gives the tables of shells other bits than the host does";
        return ShellKernels::suit(context) ? "" : context.processor().name + " has no doubles, which shells need";
    }

    /// The solver is kept, because memory that is made anew for each patch costs as much as a set-up; and one for
    /// another grid too, because a law of large deflections has its own. A shell that is solved once more is not set up
    /// again.
    [[nodiscard]] FootprintSolution solve(const Shell& wanted, std::span<const Footprint> given, std::size_t whole,
                                          double tolerance, double drawn, Stresses stresses)
    {
        const bool isKept = wanted.bending.grid.nodes() <= kMostKeptNodes;
        try {
            makeReady(wanted);
            FootprintSolution solution =
                byMultigridOfShells(*shells.front().solver, wanted, given, whole, tolerance, drawn, stresses);
            if (!isKept) shells.pop_front();
            return solution;
        } catch (...) {
            shells.clear(); // half of one may be another shell's
            throw;
        }
    }

    [[nodiscard]] int memories() const
    {
        return loads.made + footprints.made + inFloats.prepared.made + inDoubles.prepared.made + directsMade;
    }

    [[nodiscard]] bool isHost() const { return context.processor().kind == compute::ProcessorKind::host; }
    [[nodiscard]] bool hasDoubles() const { return context.processor().float64; }
    [[nodiscard]] bool reaches(double tolerance) const
    {
        return hasDoubles() || !(tolerance < MultigridPlateSolver::kLeastFloatTolerance);
    }

    /// Returns how many loads are solved together. A GPU has lanes to fill. On the host the fields of one load fit its
    /// cache and those of 49 do not: one after the other they take two thirds of the time (65 nodes: 15 in place of 24
    /// ms). Several batches are as equal as can be.
    [[nodiscard]] std::size_t batchOf(const PlateGrid& grid, std::size_t all)
    {
        if (likeTheHost) return 1;
        const std::size_t most    = std::min(shortage.most(), context.limits().buffer / sizeof(double));
        const std::size_t each    = std::max<std::size_t>(1, most / grid.nodes());
        const std::size_t batches = (all + each - 1) / each;
        return (all + batches - 1) / batches;
    }

    /// Calls solve(batch) with the number of loads that are solved together: half as many where memory runs out.
    template <class Solve>
    auto inBatches(const Plate& plate, std::size_t all, const Solve& solve)
    {
        for (;;) {
            const std::size_t batch = batchOf(plate.grid, all);
            try {
                auto answer = solve(batch);
                shortage.fitted(batch * plate.grid.nodes());
                return answer;
            } catch (const compute::ProcessorOutOfMemory&) {
                if (batch == 1) throw;
                shortage.foundAt((batch / 2 + 1) * plate.grid.nodes());
            }
        }
    }

    [[nodiscard]] std::vector<PlateSolution> solve(const Plate& wanted, std::span<const NodeField> nodalForces,
                                                   double tolerance)
    {
        return inBatches(wanted, nodalForces.size(), [&](std::size_t batch) {
            std::vector<PlateSolution> solutions;
            const double               setUp = loads.prepare(context, kernels, wanted, batch, tolerance);
            for (auto left = nodalForces; !left.empty();) {
                const auto now = left.first(std::min(batch, left.size()));
                left           = left.subspan(now.size());
                for (PlateSolution& solution : solveFilledUp(now)) solutions.push_back(std::move(solution));
            }
            for (PlateSolution& solution : solutions) solution.report.setUpMilliseconds = setUp;
            return solutions;
        });
    }

    [[nodiscard]] double timeOf(const PlateTrial& trial, const Clock& clock)
    {
        return usualTime(clock, trial.apart, [&] {
            (void)solve(trial.plate, trial.loads, trial.loads.size() / 2, trial.tolerance, PlateSolver::kAsWorks);
        });
    }

    /// \return the solution; not converged if that of any load is not
    [[nodiscard]] FootprintSolution solve(const Plate& wanted, std::span<const Footprint> given, std::size_t whole,
                                          double tolerance, double drawn)
    {
        return inBatches(wanted, given.size(), [&](std::size_t batch) {
            return likeTheHost ? solveByEights(wanted, given, whole, tolerance, drawn)
                               : solveByBatches(wanted, given, whole, tolerance, drawn, batch);
        });
    }

private:
    static constexpr std::size_t kEight = 8, kMostShells = 2;

    /// Puts a solver of this shell in front.
    void makeReady(const Shell& wanted)
    {
        auto found = std::ranges::find_if(
            shells, [&](const PreparedShell& kept) { return kept.shell.bending.grid == wanted.bending.grid; });
        if (found != shells.end()) {
            shells.splice(shells.begin(), shells, found);
            if (areAlike(shells.front().shell, wanted)) return;
            shells.front().solver->setShell(wanted);
        } else {
            if (shells.size() >= kMostShells) shells.pop_back(); // its memory goes before the next one's comes
            shells.emplace_front();
            if (!isHost() && !kernelsOfShells) kernelsOfShells.emplace(context);
            if (isHost())
                shells.front().solver.emplace(wanted);
            else
                shells.front().solver.emplace(wanted, context, *kernelsOfShells);
        }
        shells.front().shell = wanted;
    }

    [[nodiscard]] static std::vector<std::size_t> indices(std::size_t count)
    {
        std::vector<std::size_t> all(count);
        std::iota(all.begin(), all.end(), std::size_t(0));
        return all;
    }

    /// Solves for at most as many loads as were prepared for. A last batch that is not full is filled up with loads of
    /// nothing, which are finished at once: a solver for fewer loads would need memory of its own.
    [[nodiscard]] std::vector<PlateSolution> solveFilledUp(std::span<const NodeField> now)
    {
        if (now.size() == loads.loads) return loads.solver->solve(now);
        std::vector<NodeField> full(now.begin(), now.end());
        full.resize(loads.loads, NodeField(loads.plate.grid));
        std::vector<PlateSolution> solutions = loads.solver->solve(full);
        solutions.erase(solutions.begin() + std::ptrdiff_t(now.size()), solutions.end());
        return solutions;
    }

    [[nodiscard]] FootprintSolution solveByBatches(const Plate& wanted, std::span<const Footprint> given,
                                                   std::size_t whole, double tolerance, double drawn, std::size_t batch)
    {
        FootprintSolution solution;
        solution.responses.resize(given.size());
        const std::vector<std::size_t> all    = indices(given.size());
        const auto [by, setUp]                = prepareFootprints(wanted, tolerance, drawn, batch);
        const bool                 floatsSuit = roundsLess(by->solver->rounding(), tolerance);
        std::optional<SolveReport> worst;
        for (std::span<const std::size_t> left = all; !left.empty();) {
            const auto now     = left.first(std::min(batch, left.size()));
            left               = left.subspan(now.size());
            SolveReport report = solveTogether(*by, given, now, solution);
            report.converged   = report.converged && floatsSuit;
            if (!worst || (worst->converged && !report.converged)) worst = report;
            if (whole >= now.front() && whole <= now.back())
                solution.whole.deflection = by->solver->deflectionOf(whole - now.front());
        }
        solution.whole.report                   = *worst;
        solution.whole.report.setUpMilliseconds = setUp;
        return solution;
    }

    [[nodiscard]] FootprintSolution solveByEights(const Plate& wanted, std::span<const Footprint> given,
                                                  std::size_t whole, double tolerance, double drawn)
    {
        if (tolerance < 1 && DirectPlate::pays(wanted, given.size()))
            if (auto solution = solveDirectly(wanted, given, whole, std::min(drawn, looseFor(tolerance))))
                return std::move(*solution);
        FootprintSolution solution;
        solution.responses.resize(given.size());
        const auto [alone, setUp] = prepareFootprints(wanted, tolerance, drawn, 1);
        SolveReport report        = solveTogether(*alone, given, {&whole, 1}, solution);
        report.setUpMilliseconds  = setUp;
        solution.whole            = {alone->solver->deflectionOf(0), report};

        std::vector<std::size_t> others = indices(given.size());
        others.erase(others.begin() + std::ptrdiff_t(whole));
        Prepared* const by = others.size() < kEight ? nullptr : &prepareEights(wanted, *alone, tolerance);
        for (std::span<const std::size_t> left = others; !left.empty();) {
            const auto eight = left.first(std::min(kEight, left.size()));
            left             = left.subspan(eight.size());
            if (by && eight.size() == kEight && solveTogether(*by, given, eight, solution).converged) continue;
            for (const std::size_t n : eight) { // too few, or too hard for floats
                const SolveReport own = solveTogether(*alone, given, {&n, 1}, solution);
                if (!own.converged) solution.whole.report = own;
            }
        }
        return solution;
    }

    /// \param error  that the deflection may have [1]
    [[nodiscard]] std::optional<FootprintSolution> solveDirectly(const Plate& wanted, std::span<const Footprint> given,
                                                                 std::size_t whole, double error)
    {
        if (whyUnsolvable(wanted)) return std::nullopt; // multigrid says so
        if (!direct || !direct->suits(wanted)) {
            direct.reset(); // its memory goes before the next one's comes
            direct.emplace(wanted);
            ++directsMade;
        }
        return direct->solve(wanted, given, whole, error);
    }

    /// Makes a solver ready for footprints: the one for loads where a deflection is wanted more exactly than works ask
    /// for, else one of its own, so that a session that wants both in turns makes neither anew.
    /// \return the solver, and the milliseconds that it took
    std::pair<Prepared*, double> prepareFootprints(const Plate& wanted, double tolerance, double drawn,
                                                   std::size_t batch)
    {
        const double loose = looseFor(tolerance);
        Prepared&    by    = drawn < loose ? loads : footprints;
        return {&by, by.prepare(context, kernels, wanted, batch, std::min(drawn, loose))};
    }

    /// Returns whether rounding is less than the tolerance of works, in which it is not squared.
    static bool roundsLess(double rounding, double tolerance)
    {
        return rounding <= std::max(tolerance, MultigridPlateSolver::kLeastFloatTolerance);
    }

    /// Makes a solver ready for eight loads at a time: in floats, or in doubles where floats are not enough for works
    /// to this tolerance.
    [[nodiscard]] Prepared& prepareEights(const Plate& wanted, const Prepared& alone, double tolerance)
    {
        Eights& by = roundsLess(alone.solver->roundingInFloats(), tolerance) ? inFloats : inDoubles;
        if (!by.kernels)
            by.kernels.emplace(context, Schedule::automatic, by.precision,
                               isHost() ? Smoother::automatic : Smoother::chebyshev,
                               isHost() ? FieldLayout::sideBySide : FieldLayout::apart);
        by.prepared.prepare(context, *by.kernels, wanted, kEight, looseFor(tolerance));
        return by.prepared;
    }

    /// Solves for these loads in one batch, filled up as by solveFilledUp().
    static SolveReport solveTogether(Prepared& by, std::span<const Footprint> given, std::span<const std::size_t> which,
                                     FootprintSolution& to)
    {
        std::vector<Footprint> batch;
        for (const std::size_t n : which) batch.push_back(given[n]);
        batch.resize(by.loads);
        const MultigridPlateSolver::Responses found = by.solver->solveFootprints(batch);
        for (std::size_t n = 0; n < which.size(); ++n) to.responses[which[n]] = found.of[n];
        return found.report;
    }
};

struct PlateSolver::Learned {
    MemoryShortage shortage; ///< of the processor's memory for one load, in nodes
    std::string    shortageNote;
    HardPlates     hard;     ///< for multigrid
    HardPlates     beyond;   ///< multigrid, and the reference solves them no better
    HardPlates     inFloats; ///< for a processor without doubles, and the host solves them
};

PlateSolver::PlateSolver(std::string_view wanted, double patience, SoftwareBits bits)
    : PlateSolver(compute::ContextSettings{.processor = std::string(wanted), .patience = patience}, bits)
{
}

PlateSolver::PlateSolver(compute::ContextSettings settings, SoftwareBits bits)
    : bits_(bits), learned_(std::make_unique<Learned>())
{
    const std::string wanted = settings.processor;
    if (compute::isProcessorWord(wanted, kReference)) return;
    try {
        processor_ = std::make_unique<Multigrid>(settings, bits);
        note_      = processor_->context.note();
    } catch (const std::exception& error) { // the kernels do not compile, or the requested processor is refused
        if (!compute::isProcessorWord(wanted, compute::kAutoProcessor)) throw;
        note_      = error.what();
        processor_ = makeHost();
    }
    name_ = processor_->context.processor().name;
    if (!note_.empty()) noteTakeover(name_);
}

PlateSolver::~PlateSolver()                                 = default;
PlateSolver::PlateSolver(PlateSolver&&) noexcept            = default;
PlateSolver& PlateSolver::operator=(PlateSolver&&) noexcept = default;

const std::string& PlateSolver::name() const noexcept
{
    return name_;
}

const std::string& PlateSolver::note() const noexcept
{
    return note_;
}

PlateSolver::Counts PlateSolver::counts() const noexcept
{
    Counts now{takeovers_, memoriesOfLost_, attempts_};
    for (const Multigrid* by : {processor_.get(), host_.get()})
        if (by) now.memories += by->memories();
    return now;
}

std::string PlateSolver::takeoverSince(int before) const
{
    return takeovers_ > before ? takeover_ : std::string();
}

void PlateSolver::noteTakeover(const std::string& by)
{
    const std::string who = by == kReference ? "the reference solver" : by == compute::kHostProcessor ? "the host" : by;
    takeover_             = who + " took over: " + note_;
    ++takeovers_;
}

void PlateSolver::noteSolvedBy(const std::string& solver)
{
    const bool others = solver != name_;
    if (others && (!othersSolve_ || note_ != counted_)) {
        noteTakeover(solver);
        counted_ = note_;
    }
    othersSolve_ = others;
}

PlateSolution PlateSolver::solve(const Plate& plate, const NodeField& nodalForce, double tolerance)
{
    return std::move(solveAll(plate, {&nodalForce, 1}, tolerance).front());
}

std::unique_ptr<PlateSolver::Multigrid> PlateSolver::makeHost() const
{
    return std::make_unique<Multigrid>(compute::ContextSettings{.processor = std::string(compute::kHostProcessor)},
                                       bits_);
}

PlateSolver::Multigrid& PlateSolver::host()
{
    if (processor_->isHost()) return *processor_;
    if (!host_) host_ = makeHost();
    return *host_;
}

PlateSolver::Multigrid& PlateSolver::bestFor(const Plate& plate, double tolerance, std::size_t footprints)
{
    if (plate.grid.nodes() > learned_->shortage.most()) {
        note_ = learned_->shortageNote;
        return host();
    }
    if (processor_->likeTheHost && !processor_->isHost() &&
        (mayHaveRims(plate) || DirectPlate::pays(plate, footprints))) {
        note_ = processor_->context.processor().name +
                " does not solve for inclusions exactly, as the host may where the rigidity jumps";
        return host();
    }
    if (const std::string* why = processor_->isHost() ? nullptr : learned_->inFloats.knownBecause(plate, tolerance)) {
        note_ = *why;
        return host();
    }
    if (processor_->reaches(tolerance)) return *processor_;
    note_ = processor_->context.processor().name + " has no doubles, which a tolerance of " + formatNumber(tolerance) +
            " needs";
    return host();
}

template <class Answer, class Solve, class Refer>
Answer PlateSolver::byMultigrid(const Plate& plate, double tolerance, const Solve& solve, const Refer& refer,
                                std::size_t footprints)
{
    if (!processor_) return refer();
    const bool orByReference = fitsReference(plate.grid);
    if (const std::string* why = orByReference ? learned_->hard.knownBecause(plate, tolerance) : nullptr) {
        note_ = *why;
        return refer();
    }
    std::optional<Answer>      answer;
    std::exception_ptr         broken;
    std::optional<std::string> tooRound; // why a processor without doubles did not converge
    for (Multigrid* by = &bestFor(plate, tolerance, footprints); by;) {
        const bool last = by->isHost();
        bool       sure = last; // that the host does no better
        try {
            ++attempts_;
            answer = solve(*by);
            if (!last) learned_->shortage.fitted(plate.grid.nodes());
            const SolveReport& report = reportOf(*answer);
            if (report.converged) {
                if (tooRound) learned_->inFloats.remember(plate, tolerance, *tooRound);
                return std::move(*answer);
            }
            note_ = stoppedAt(report, tolerance);
            sure  = last || by->hasDoubles();
            if (!sure) tooRound = note_;
        } catch (const compute::ProcessorOutOfMemory& error) {
            if (last) throw;
            note_ = learned_->shortageNote = error.what();
            learned_->shortage.foundAt(plate.grid.nodes());
        } catch (const compute::ProcessorLost& error) {
            if (last) throw;
            loseProcessor(error);
        } catch (const SolverBrokeDown& error) {
            note_  = error.what();
            broken = std::current_exception();
        }
        by = sure ? nullptr : &host();
    }
    if (!answer) {
        if (orByReference) return refer();
        std::rethrow_exception(broken);
    }
    if (!orByReference || learned_->beyond.knownBecause(plate, tolerance)) return std::move(*answer);
    // Where rounding spoils a factorisation, as on hardly any foundation, what multigrid has reached may be nearer.
    std::optional<Answer> exact;
    try {
        exact = refer();
    } catch (const Error&) { // it cannot be factorised
    }
    const double left   = reportOf(*answer).errorEstimate.value_or(std::numeric_limits<double>::infinity());
    const double before = exact ? reportOf(*exact).errorEstimate.value_or(0) : 0; // its step leaves about the square
    if (!exact || (!reportOf(*exact).converged && (before < 1 ? before * before : before) > left)) {
        learned_->beyond.remember(plate, tolerance, note_);
        return std::move(*answer);
    }
    learned_->hard.remember(plate, tolerance, note_);
    return std::move(*exact);
}

void PlateSolver::takeHost()
{
    if (!host_) host_ = makeHost();
    memoriesOfLost_ += processor_->memories();
    processor_ = std::move(host_);
    name_      = processor_->context.processor().name;
}

void PlateSolver::loseProcessor(const std::exception& why)
{
    note_ = why.what();
    takeHost();
    noteTakeover(name_);
}

double PlateSolver::timeOf(const PlateTrial& trial, const Clock& clock)
{
    if (processor_) return processor_->timeOf(trial, clock);
    return usualTime(clock, trial.apart, [&] { (void)byReference(trial.plate, trial.loads, 0, trial.tolerance); });
}

std::vector<PlateSolver::ProcessorTime> PlateSolver::keepFaster(const PlateTrial& trial, const Clock& clock)
{
    if (!processor_ || processor_->isHost()) return {};
    std::vector<ProcessorTime> times{{name_, std::numeric_limits<double>::infinity()}};
    try {
        times[0].milliseconds = processor_->timeOf(trial, clock);
    } catch (const std::exception& error) { // lost, too small, without the doubles that the tolerance needs
        note_ = error.what();
        noteTakeover(std::string(compute::kHostProcessor));
    }
    times.push_back({std::string(compute::kHostProcessor), host().timeOf(trial, clock)});
    if (times[1].milliseconds < times[0].milliseconds) takeHost();
    return times;
}

std::vector<PlateSolution> PlateSolver::solveAll(const Plate& plate, std::span<const NodeField> nodalForces,
                                                 double tolerance)
{
    PALP_EXPECT(!nodalForces.empty(), "there is no load to solve for");
    using Answer = std::vector<PlateSolution>;
    auto answer  = byMultigrid<Answer>(
        plate, tolerance, [&](Multigrid& by) { return by.solve(plate, nodalForces, tolerance); },
        [&] { return byReference(plate, nodalForces, tolerance); });
    noteSolvedBy(answer.front().report.solver);
    return answer;
}

FootprintSolution PlateSolver::solveFootprints(const Plate& plate, std::span<const Footprint> loads, std::size_t whole,
                                               double tolerance, double drawn)
{
    PALP_EXPECT(whole < loads.size(), "the load whose deflection is wanted is one of them");
    auto answer = byMultigrid<FootprintSolution>(
        plate, tolerance, [&](Multigrid& by) { return by.solve(plate, loads, whole, tolerance, drawn); },
        [&] { return byReference(plate, loads, whole, tolerance); }, loads.size());
    noteSolvedBy(answer.whole.report.solver);
    return answer;
}

FootprintSolution PlateSolver::solveFootprints(const Shell& shell, std::span<const Footprint> loads, std::size_t whole,
                                               double tolerance, double drawn, Stresses stresses)
{
    PALP_EXPECT(whole < loads.size(), "the load whose deflection is wanted is one of them");
    FootprintSolution solution;
    if (auto exact = byFactor(shell, loads, whole, tolerance)) {
        if (stresses == Stresses::none) exact->stress = {};
        return std::move(*exact);
    }
    if (processor_) solution = byProcessor(shell, loads, whole, tolerance, drawn, stresses);
    if (!processor_ || (!solution.whole.report.converged && fitsReference(shell.bending.grid))) {
        if (processor_) note_ = stoppedAt(solution.whole.report, tolerance);
        solution = byReference(shell, loads, whole, tolerance);
    }
    if (stresses == Stresses::none) solution.stress = {};
    // As DirectShell does: the void's own deflection is nothing that stretches a sheet.
    goOnBeyondSheet(solution.whole.deflection, shell);
    noteSolvedBy(solution.whole.report.solver);
    return solution;
}

std::optional<FootprintSolution> PlateSolver::byFactor(const Shell& shell, std::span<const Footprint> loads,
                                                       std::size_t whole, double tolerance)
{
    if (!processor_ || !DirectShell::pays(shell) || !fitsReference(shell.bending.grid)) return std::nullopt;
    // A law of large deflections has a grid of its own; a factor of a large one takes hundreds of megabytes.
    const std::size_t kept = shell.bending.grid.nodes() > kMostKeptFactor ? 1 : 2;
    const auto        known =
        std::ranges::find_if(factors_, [&](const auto& of) { return areAlike(of.shell(), shell) && of.has(loads); });
    if (known != factors_.end()) {
        factors_.splice(factors_.begin(), factors_, known);
    } else {
        std::vector<double> memory;
        for (; factors_.size() >= kept; factors_.pop_back()) memory = factors_.back().takeMemory();
        factors_.emplace_front(shell, loads, std::move(memory));
    }
    if (!factors_.front().has(loads)) return std::nullopt;
    return factors_.front().solve(loads, whole, tolerance);
}

FootprintSolution PlateSolver::byProcessor(const Shell& shell, std::span<const Footprint> loads, std::size_t whole,
                                           double tolerance, double drawn, Stresses stresses)
{
    if (std::string why = processor_->whyNoShells(); !why.empty()) {
        note_ = std::move(why);
        return host().solve(shell, loads, whole, tolerance, drawn, stresses);
    }
    try {
        return processor_->solve(shell, loads, whole, tolerance, drawn, stresses);
    } catch (const compute::ProcessorOutOfMemory& error) {
        if (processor_->isHost()) throw;
        note_ = error.what();
    } catch (const compute::ProcessorLost& error) {
        if (processor_->isHost()) throw;
        loseProcessor(error);
    }
    return host().solve(shell, loads, whole, tolerance, drawn, stresses);
}

FootprintSolution PlateSolver::byReference(const Shell& shell, std::span<const Footprint> loads, std::size_t whole,
                                           double tolerance)
{
    const auto                 began = std::chrono::steady_clock::now();
    const ReferenceShellSolver solver(shell);
    const auto                 made = std::chrono::steady_clock::now();
    const Shear                shear(shell);
    const CurvedBending        curved(shell);
    FootprintSolution          solution;
    for (std::size_t n = 0; n < loads.size(); ++n) {
        ShellSolution of = solver.solve(loads[n].load(shell.bending.grid));
        solution.responses.push_back(responseOf(loads[n], of.deflection));
        solution.responses.back().work += shear.workOf(of.deflection) - squeezeWork(shell, of.deflection, loads[n]);
        solution.responses.back().curved = curved.workOf(of.deflection);
        SolveReport& report              = solution.whole.report;
        const bool   converged           = of.errorEstimate * of.errorEstimate <= tolerance; // as for plates
        if (n == whole) {
            solution.whole.deflection = std::move(of.deflection);
            solution.stress           = std::move(of.stressFunction);
        }
        if (!report.converged || (converged && n != whole)) continue; // the first that did not, else the whole one's
        report.solver        = kReference;
        report.errorEstimate = of.errorEstimate;
        report.converged     = converged;
    }
    using Milliseconds                      = std::chrono::duration<double, std::milli>;
    solution.whole.report.setUpMilliseconds = Milliseconds(made - began).count();
    solution.whole.report.milliseconds      = Milliseconds(std::chrono::steady_clock::now() - made).count();
    return solution;
}

FootprintSolution PlateSolver::byReference(const Plate& plate, std::span<const Footprint> loads, std::size_t whole,
                                           double tolerance)
{
    std::vector<NodeField> fields;
    for (const Footprint& load : loads) fields.push_back(load.load(plate.grid));
    std::vector<PlateSolution> solutions = byReference(plate, fields, tolerance);
    FootprintSolution          solution;
    for (std::size_t n = 0; n < loads.size(); ++n)
        solution.responses.push_back(responseOf(loads[n], solutions[n].deflection));
    const SolveReport worst = reportOf(solutions);
    solution.whole          = std::move(solutions[whole]);
    if (!worst.converged) solution.whole.report = worst;
    return solution;
}

std::vector<PlateSolution> PlateSolver::byReference(const Plate& plate, std::span<const NodeField> nodalForces,
                                                    double tolerance)
{
    const ReferencePlateSolver solver(plate);
    std::vector<PlateSolution> solutions;
    for (const NodeField& load : nodalForces) {
        solutions.push_back(solver.solve(load));
        SolveReport& report      = solutions.back().report;
        report.setUpMilliseconds = solver.factoriseMilliseconds();
        // The estimate is that of the error before the step of refinement, which removes as large a share again.
        const double before = report.errorEstimate.value_or(0);
        report.converged    = before * before <= tolerance;
    }
    return solutions;
}

} // namespace palp
