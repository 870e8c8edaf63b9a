#include "engine/plate/plate_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "engine/compute/context.h"
#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"
#include "engine/plate/reference/reference_plate_solver.h"

namespace palp {
namespace {

/// Size beyond which factorising takes a minute and gigabytes: an answer that is reported as not converged is then
/// better.
bool fitsReference(const PlateGrid& grid)
{
    return grid.nodes() <= 513 * 513;
}

std::string stoppedAt(const SolveReport& report)
{
    return "the multigrid solver stopped at an error of about " + formatNumber(*report.errorEstimate);
}

bool sameButRigidity(const Plate& a, const Plate& b)
{
    return a.grid == b.grid && a.edges == b.edges && a.poissonRatio == b.poissonRatio && a.foundation == b.foundation;
}

} // namespace

struct PlateSolver::Multigrid {
    /// A solver for one number of loads, and the plate that it was made for.
    struct Prepared {
        std::optional<MultigridPlateSolver> solver;
        Plate                               plate;
        double                              tolerance = 0;
        std::size_t                         loads     = 0; ///< that it takes together

        /// Makes the solver ready for a rigidity.
        /// \return milliseconds that it took
        double prepare(compute::Context& context, const PlateKernels& kernels, const Plate& wanted,
                       std::size_t wantedLoads, double wantedTolerance)
        {
            const auto began = std::chrono::steady_clock::now();
            if (solver && sameButRigidity(plate, wanted) && tolerance == wantedTolerance && loads == wantedLoads) {
                solver->setRigidity(wanted.rigidity);
            } else {
                solver.reset(); // its memory goes before the next one's comes
                solver.emplace(context, kernels, wanted,
                               MultigridPlateSolver::Settings{.tolerance = wantedTolerance, .loads = int(wantedLoads)});
                plate     = wanted;
                tolerance = wantedTolerance;
                loads     = wantedLoads;
            }
            return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
        }
    };

    compute::Context            context;
    bool                        likeTheHost; ///< smooths as the host does, and takes one load after the other
    PlateKernels                kernels;
    std::optional<PlateKernels> kernelsOfEights; ///< once they are needed
    Prepared                    loads, eights;

    Multigrid(const compute::ContextSettings& settings, SoftwareBits bits)
        : context(settings), likeTheHost(isHost() || (bits == SoftwareBits::ofTheHost &&
                                                      context.processor().kind == compute::ProcessorKind::software)),
          kernels(context, Schedule::automatic, Precision::best,
                  likeTheHost ? Smoother::chebyshev : Smoother::automatic)
    {
    }

    [[nodiscard]] bool isHost() const { return context.processor().kind == compute::ProcessorKind::host; }

    /// Returns how many loads are solved together. A GPU has lanes to fill. On the host the fields of one load fit its
    /// cache and those of 49 do not: one after the other they take two thirds of the time (65 nodes: 15 in place of 24
    /// ms).
    [[nodiscard]] std::size_t batchOf(std::size_t all) const { return likeTheHost ? 1 : all; }

    [[nodiscard]] std::vector<PlateSolution> solve(const Plate& wanted, std::span<const NodeField> nodalForces,
                                                   double tolerance)
    {
        const std::size_t          batch = batchOf(nodalForces.size());
        const double               setUp = loads.prepare(context, kernels, wanted, batch, tolerance);
        std::vector<PlateSolution> solutions;
        for (; !nodalForces.empty(); nodalForces = nodalForces.subspan(batch))
            for (PlateSolution& solution : loads.solver->solve(nodalForces.first(batch))) {
                solution.report.setUpMilliseconds = setUp;
                solutions.push_back(std::move(solution));
            }
        return solutions;
    }

    /// \return the solution; not converged if that of any load is not
    [[nodiscard]] FootprintSolution solve(const Plate& wanted, std::span<const Footprint> given, std::size_t whole,
                                          double tolerance)
    {
        FootprintSolution solution;
        solution.responses.resize(given.size());
        const std::vector<std::size_t>     all    = indices(given.size());
        const std::span<const std::size_t> first  = batchOf(all.size()) == 1 ? std::span(all).subspan(whole, 1) : all;
        const double                       setUp  = loads.prepare(context, kernels, wanted, first.size(), tolerance);
        SolveReport                        report = solveTogether(loads, given, first, solution);
        report.setUpMilliseconds                  = setUp;
        solution.whole                            = {loads.solver->deflectionOf(first.size() == 1 ? 0 : whole), report};
        if (first.size() == all.size()) return solution;

        std::vector<std::size_t> others = all;
        others.erase(others.begin() + std::ptrdiff_t(whole));
        if (others.size() >= kEight) prepareEights(wanted, tolerance);
        for (std::span<const std::size_t> left = others; !left.empty();) {
            const auto eight = left.first(std::min(kEight, left.size()));
            left             = left.subspan(eight.size());
            if (eight.size() == kEight && solveTogether(eights, given, eight, solution).converged) continue;
            for (const std::size_t n : eight) { // too few, or too much contrast for floats
                const SolveReport own = solveTogether(loads, given, {&n, 1}, solution);
                if (!own.converged) solution.whole.report = own;
            }
        }
        return solution;
    }

private:
    static constexpr std::size_t kEight = 8;

    [[nodiscard]] static std::vector<std::size_t> indices(std::size_t count)
    {
        std::vector<std::size_t> all(count);
        std::iota(all.begin(), all.end(), std::size_t(0));
        return all;
    }

    void prepareEights(const Plate& wanted, double tolerance)
    {
        constexpr double kLoosest = 1e-2; // beyond it the estimate of the first steps is a guess
        if (!kernelsOfEights)
            kernelsOfEights.emplace(context, Schedule::automatic, Precision::floatGradients, Smoother::chebyshev,
                                    isHost() ? FieldLayout::sideBySide : FieldLayout::apart);
        eights.prepare(context, *kernelsOfEights, wanted, kEight, std::min(kLoosest, std::sqrt(tolerance)));
    }

    /// Solves for these loads in one batch.
    static SolveReport solveTogether(Prepared& by, std::span<const Footprint> given, std::span<const std::size_t> which,
                                     FootprintSolution& to)
    {
        std::vector<Footprint> batch;
        for (const std::size_t n : which) batch.push_back(given[n]);
        const MultigridPlateSolver::Responses found = by.solver->solveFootprints(batch);
        for (std::size_t n = 0; n < which.size(); ++n) to.responses[which[n]] = found.of[n];
        return found.report;
    }
};

PlateSolver::PlateSolver(std::string_view wanted, double patience, SoftwareBits bits)
{
    if (compute::isProcessorWord(wanted, kReference)) return;
    compute::ContextSettings settings;
    settings.processor = std::string(wanted);
    settings.patience  = patience;
    try {
        multigrid_ = std::make_unique<Multigrid>(settings, bits);
        note_      = multigrid_->context.note();
    } catch (const std::exception& error) { // the kernels do not compile, or the requested processor is refused
        if (!compute::isProcessorWord(wanted, compute::kAutoProcessor)) throw;
        note_              = error.what();
        settings.processor = compute::kHostProcessor;
        multigrid_         = std::make_unique<Multigrid>(settings, bits);
    }
    name_ = multigrid_->context.processor().name;
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

PlateSolution PlateSolver::solve(const Plate& plate, const NodeField& nodalForce, double tolerance)
{
    return std::move(solveAll(plate, {&nodalForce, 1}, tolerance).front());
}

std::vector<PlateSolution> PlateSolver::solveAll(const Plate& plate, std::span<const NodeField> nodalForces,
                                                 double tolerance)
{
    PALP_EXPECT(!nodalForces.empty(), "there is no load to solve for");
    if (multigrid_) {
        try {
            std::vector<PlateSolution> solutions = multigrid_->solve(plate, nodalForces, tolerance);
            const auto                 failed =
                std::ranges::find_if(solutions, [](const PlateSolution& s) { return !s.report.converged; });
            if (failed == solutions.end() || !fitsReference(plate.grid)) return solutions;
            note_ = stoppedAt(failed->report);
        } catch (const compute::ProcessorLost& error) {
            lose(error);
        }
    }
    return byReference(plate, nodalForces, tolerance);
}

FootprintSolution PlateSolver::solveFootprints(const Plate& plate, std::span<const Footprint> loads, std::size_t whole,
                                               double tolerance)
{
    PALP_EXPECT(whole < loads.size(), "the load whose deflection is wanted is one of them");
    if (multigrid_) {
        try {
            FootprintSolution solution = multigrid_->solve(plate, loads, whole, tolerance);
            if (solution.whole.report.converged || !fitsReference(plate.grid)) return solution;
            note_ = stoppedAt(solution.whole.report);
        } catch (const compute::ProcessorLost& error) {
            lose(error);
        }
    }
    std::vector<NodeField> fields;
    for (const Footprint& load : loads) fields.push_back(load.load(plate.grid));
    std::vector<PlateSolution> solutions = byReference(plate, fields, tolerance);
    FootprintSolution          solution;
    for (std::size_t n = 0; n < loads.size(); ++n)
        solution.responses.push_back(responseOf(loads[n], solutions[n].deflection));
    solution.whole = std::move(solutions[whole]);
    return solution;
}

void PlateSolver::lose(const std::exception& why)
{
    note_ = why.what();
    name_ = kReference;
    multigrid_.reset();
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
