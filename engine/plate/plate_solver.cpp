#include "engine/plate/plate_solver.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
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

bool sameButRigidity(const Plate& a, const Plate& b)
{
    return a.grid == b.grid && a.edges == b.edges && a.poissonRatio == b.poissonRatio && a.foundation == b.foundation;
}

} // namespace

struct PlateSolver::Multigrid {
    compute::Context                    context;
    bool                                likeTheHost; ///< smooths as the host does, and takes one load after the other
    PlateKernels                        kernels;
    std::optional<MultigridPlateSolver> solver;
    Plate                               plate; ///< of the solver
    double                              tolerance = 0;
    std::size_t                         loads     = 0; ///< that the solver takes together

    Multigrid(const compute::ContextSettings& settings, SoftwareBits bits)
        : context(settings), likeTheHost(context.processor().kind == compute::ProcessorKind::host ||
                                         (bits == SoftwareBits::ofTheHost &&
                                          context.processor().kind == compute::ProcessorKind::software)),
          kernels(context, Schedule::automatic, Precision::best,
                  likeTheHost ? Smoother::chebyshev : Smoother::automatic)
    {
    }

    /// Returns how many loads are solved together. A GPU has lanes to fill. On the host the fields of one load fit its
    /// cache and those of 49 do not: one after the other they take two thirds of the time (65 nodes: 15 in place of 24
    /// ms).
    [[nodiscard]] std::size_t batchOf(std::size_t all) const { return likeTheHost ? 1 : all; }

    /// \return milliseconds that it took
    double prepare(const Plate& wanted, std::size_t wantedLoads, double wantedTolerance)
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

    [[nodiscard]] std::vector<PlateSolution> solve(const Plate& wanted, std::span<const NodeField> nodalForces,
                                                   double wantedTolerance)
    {
        const std::size_t          batch = batchOf(nodalForces.size());
        const double               setUp = prepare(wanted, batch, wantedTolerance);
        std::vector<PlateSolution> solutions;
        for (; !nodalForces.empty(); nodalForces = nodalForces.subspan(batch))
            for (PlateSolution& solution : solver->solve(nodalForces.first(batch))) {
                solution.report.setUpMilliseconds = setUp;
                solutions.push_back(std::move(solution));
            }
        return solutions;
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
            note_ = "the multigrid solver stopped at an error of about " + formatNumber(*failed->report.errorEstimate);
        } catch (const compute::ProcessorLost& error) {
            note_ = error.what();
            name_ = kReference;
            multigrid_.reset();
        }
    }
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
