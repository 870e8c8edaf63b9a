#include "engine/plate/multigrid/multigrid_shell_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/compute/context.h"
#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/plate/multigrid/detail/shell_gradients.h"
#include "engine/plate/multigrid/detail/shell_host.h"
#include "engine/plate/multigrid/detail/shell_processor.h"

namespace palp {

struct MultigridShellSolver::Impl {
    /// Conjugate gradients by vectors of one kind.
    template <class Fields>
    using By = std::unique_ptr<Fields>; ///< once it is needed

    PlateGrid                  grid{};
    double                     stiffness = 0, phiUnit = 0; ///< [N/m]; phi over its unknown [N]
    const HostVariant&         host    = hostVariant();
    compute::Context*          context = nullptr; ///< of a processor of Vulkan; null: the host solves
    const ShellKernels*        kernels = nullptr;
    std::vector<ShellLevel>    levels;
    ShellCoarseSolver          coarse;
    By<HostShellFields<false>> alone;
    By<HostShellFields<true>>  together;
    By<ProcessorShellFields>   single, many; ///< of one load; of as many as were solved for last
    double                     setUpMilliseconds = 0;

    void prepare(const Shell& shell)
    {
        const auto   began    = std::chrono::steady_clock::now();
        const double rigidity = geometricMean(shell.bending.rigidity.values());
        const bool   sameGrid = std::exchange(grid, shell.bending.grid) == shell.bending.grid;
        stiffness             = rigidity / (grid.spacingX * grid.spacingZ);
        phiUnit               = std::sqrt(rigidity / geometricMean(shell.membraneCompliance.values()));
        makeLevels(shell, *host.kernels, levels);
        const std::vector<std::ptrdiff_t> before(coarse.places().begin(), coarse.places().end());
        coarse.factorise(levels.back(), *host.kernels);
        // The coarsest level's answer is written where there are unknowns: elsewhere its vectors keep what they were
        // made of.
        if (!(sameGrid && std::ranges::equal(before, coarse.places()))) {
            alone.reset();
            together.reset();
            single.reset();
            many.reset();
        }
        for (const By<ProcessorShellFields>* by : {&single, &many})
            if (*by) (*by)->setLevels(coarse);
        setUpMilliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
    }

    /// What is wanted of all loads.
    struct Wanted {
        double tolerance;
        int    mostSteps;
        bool   stressFunctions;
    };

    /// Solves for these loads at once, by vectors that have been made for as many or more.
    template <class Fields>
    void solve(Fields& fields, std::span<const PlacedLoad> loads, const Wanted& wanted,
               std::vector<ShellAnswer>& answers)
    {
        const auto began = std::chrono::steady_clock::now();
        fields.setRight(loads);
        // Loads in doubles, one on the host or those of a processor, keep their bits until several may stop together.
        const auto states = ShellGradients<Fields>(fields).solve(wanted.tolerance, wanted.mostSteps);
        if constexpr (std::is_same_v<Fields, ProcessorShellFields>) fields.fetch();
        const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
        for (std::size_t n = 0; n < loads.size(); ++n)
            answers.push_back({fieldOf(fields, n, 0, 1 / stiffness),
                               wanted.stressFunctions ? fieldOf(fields, n, 1, phiUnit / stiffness) : NodeField(),
                               states[n].work / stiffness, reportOf(states[n], wall)});
    }

    /// Returns the deflections of a load, or its stress function.
    template <class Fields>
    [[nodiscard]] NodeField fieldOf(const Fields& fields, std::size_t load, int which, double unit) const
    {
        const ShellLayout& layout = levels.front().layout;
        NodeField          field(grid);
        double*            to = field.values().data();
        for (int i = 0; i <= grid.cellsX; ++i) {
            const std::ptrdiff_t even = placeIn(layout, i, 0, which), odd = placeIn(layout, i, 1, which);
            for (int j = 0; j <= grid.cellsZ; ++j)
                *to++ = fields.answer(load, (j % 2 == 0 ? even : odd) + j / 2) * unit;
        }
        return field;
    }

    /// \return how many of the loads it has solved for
    std::size_t solveByHost(std::span<const PlacedLoad> left, const Wanted& wanted, std::vector<ShellAnswer>& answers)
    {
        constexpr std::size_t kFewest = 3; // from that many on eight at a time take less time
        if (left.size() < kFewest) {
            if (!alone) alone = std::make_unique<HostShellFields<false>>(levels, coarse, *host.kernels);
            solve(*alone, left.first(1), wanted, answers);
            return 1;
        }
        if (!together) together = std::make_unique<HostShellFields<true>>(levels, coarse, *host.together);
        const std::size_t count = std::min(left.size(), std::size_t(kLoadsTogether));
        solve(*together, left.first(count), wanted, answers);
        return count;
    }

    /// The same on a processor of Vulkan, of as many loads together as fit a share of its memory.
    std::size_t solveByProcessor(std::span<const PlacedLoad> left, const Wanted& wanted,
                                 std::vector<ShellAnswer>& answers)
    {
        constexpr std::size_t     kMostBytes = std::size_t(256) << 20;
        const std::size_t         each       = ProcessorShellFields::bytesOf(levels.front().layout);
        const std::size_t         count      = std::clamp<std::size_t>(kMostBytes / each, 1, left.size());
        By<ProcessorShellFields>& by         = count == 1 ? single : many;
        if (!by || by->loads() < count) {
            by.reset(); // its memory goes before the next one's comes
            by = std::make_unique<ProcessorShellFields>(*context, kernels->all(), levels, coarse, count);
            by->setLevels(coarse);
        }
        solve(*by, left.first(count), wanted, answers);
        return count;
    }

    [[nodiscard]] std::vector<ShellAnswer> solve(std::span<const PlacedLoad> loads, const Wanted& wanted)
    {
        PALP_EXPECT(wanted.tolerance > 0 && wanted.mostSteps > 0, "a tolerance and a number of steps above 0");
        std::vector<ShellAnswer> answers;
        for (auto left = loads; !left.empty();)
            left = left.subspan(context ? solveByProcessor(left, wanted, answers) : solveByHost(left, wanted, answers));
        return answers;
    }

    [[nodiscard]] std::vector<ShellAnswer> solve(std::span<const Footprint> loads, const Wanted& wanted)
    {
        std::vector<PlacedLoad> parts;
        for (const Footprint& load : loads) {
            PALP_EXPECT(load.parts.empty() || load.parts.back().node < grid.nodes(), "a load on another grid");
            parts.push_back(placed(levels.front(), load));
        }
        return solve(parts, wanted);
    }

    [[nodiscard]] SolveReport reportOf(const Gradients& state, double wall) const
    {
        constexpr double kStep = 2.3 * (4 * kShellSweeps / 2 + 2) * 4 / 3; // coupled rows over a plate's; levels [1]
        return {.solver            = context ? context->processor().name : std::string(compute::kHostProcessor),
                .iterations        = state.steps,
                .errorEstimate     = state.estimate(),
                .workUnits         = kStep * state.steps,
                .converged         = state.converged,
                .setUpMilliseconds = setUpMilliseconds,
                .milliseconds      = wall,
                .processorMilliseconds{}};
    }
};

MultigridShellSolver::MultigridShellSolver(const Shell& shell) : impl_(std::make_unique<Impl>())
{
    setShell(shell);
}

MultigridShellSolver::MultigridShellSolver(const Shell& shell, compute::Context& context, const ShellKernels& kernels)
    : impl_(std::make_unique<Impl>())
{
    impl_->context = &context;
    impl_->kernels = &kernels;
    setShell(shell);
}

void MultigridShellSolver::setShell(const Shell& shell)
{
    if (const auto why = whyUnsolvable(shell)) throw Error("the shell cannot be solved: " + *why);
    impl_->prepare(shell);
}

MultigridShellSolver::~MultigridShellSolver()                                          = default;
MultigridShellSolver::MultigridShellSolver(MultigridShellSolver&&) noexcept            = default;
MultigridShellSolver& MultigridShellSolver::operator=(MultigridShellSolver&&) noexcept = default;

std::vector<ShellAnswer> MultigridShellSolver::solve(std::span<const NodeField> nodalForces, double tolerance,
                                                     int mostSteps)
{
    std::vector<Footprint> loads;
    for (const NodeField& forces : nodalForces) {
        PALP_EXPECT(forces.on(impl_->grid), "forces on another grid");
        loads.emplace_back(forces);
    }
    return impl_->solve(loads, {tolerance, mostSteps, true});
}

std::vector<ShellAnswer> MultigridShellSolver::solve(std::span<const ShellLoad> loads, double tolerance, int mostSteps)
{
    std::vector<PlacedLoad> parts;
    for (const ShellLoad& load : loads) {
        PALP_EXPECT(load.onW.on(impl_->grid) && load.onPhi.on(impl_->grid), "a load on another grid");
        parts.push_back(placed(impl_->levels.front(), load, impl_->phiUnit));
    }
    return impl_->solve(parts, {tolerance, mostSteps, true});
}

std::vector<ShellAnswer> MultigridShellSolver::solve(std::span<const Footprint> loads, double tolerance, int mostSteps)
{
    return impl_->solve(loads, {tolerance, mostSteps, false});
}

} // namespace palp
