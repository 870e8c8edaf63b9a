#include "engine/plate/multigrid/multigrid_shell_solver.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/plate/multigrid/detail/host_call.h"
#include "engine/plate/multigrid/detail/shell_level.h"

namespace palp {
namespace {

constexpr int kSweeps = 2; ///< in red and black, before and after the coarser levels

/// The kernels for one load, or for eight side by side.
template <bool kTogether>
constexpr int kLoads = kTogether ? kLoadsTogether : 1;

/// One symmetric V cycle, in floats.
template <bool kTogether>
class ShellCycle {
public:
    ShellCycle(const std::vector<ShellLevel>& levels, const ShellCoarseSolver& coarse, const HostKernels& kernels)
        : kernels_(kernels), levels_(levels), coarse_(coarse)
    {
        for (const ShellLevel& level : levels) {
            const std::size_t numbers = numbersOf(level.layout) * kLoads<kTogether>;
            fields_.push_back({std::vector<float>(numbers), std::vector<float>(numbers), std::vector<float>(numbers),
                               std::vector<float>(numbers), std::vector<float>(numbers)});
        }
    }

    /// Returns about K^-1 b; but for rounding the same symmetric matrix at each call.
    const std::vector<float>& precondition(const std::vector<float>& b)
    {
        cycle(0, b.data());
        return last();
    }
    /// Returns the last call's answer.
    [[nodiscard]] const std::vector<float>& last() const { return fields_.front().x; }

    /// Returns an answer by nested iteration: that of the coarsest level, refined, and on each level between improved by
    /// one cycle alone. (A step of conjugate gradients there may break down.)
    const std::vector<float>& start(const std::vector<float>& b)
    {
        const std::size_t last = fields_.size() - 1;
        for (std::size_t n = 0; n < last; ++n)
            transfer(kernels_.shellRestrict, n, n == 0 ? b.data() : fields_[n].load.data(), fields_[n + 1].load.data());
        coarse_.solve(kernels_, last == 0 ? b.data() : fields_[last].load.data(), fields_[last].guess.data());
        for (std::size_t n = last; n-- > 0;) {
            std::ranges::fill(fields_[n].guess, 0.0F);
            transfer(kernels_.shellProlong, n, fields_[n + 1].guess.data(), fields_[n].guess.data());
            if (n > 0) improve(n);
        }
        return fields_.front().guess;
    }

private:
    /// Of one level.
    struct Fields {
        std::vector<float> x, b, r;     ///< answer, right side, and what is left of it
        std::vector<float> load, guess; ///< of the start
    };

    void improve(std::size_t n)
    {
        Fields& at = fields_[n];
        callHost(kernels_.shellResidual, ShellPush{.layout = levels_[n].layout},
                 {levels_[n].entries.data(), at.load.data(), at.guess.data(), at.b.data()});
        cycle(n, at.b.data());
        for (std::size_t m = 0; m < at.x.size(); ++m) at.guess[m] += at.x[m];
    }

    void cycle(std::size_t n, const float* b)
    {
        Fields& at = fields_[n];
        if (n + 1 == fields_.size()) return coarse_.solve(kernels_, b, at.x.data());
        const ShellLevel& level = levels_[n];
        smooth(n, b, {.layout = level.layout, .colour = 0, .fromZero = true}, at.r.data());
        transfer(kernels_.shellRestrict, n, at.r.data(), fields_[n + 1].b.data());
        cycle(n + 1, fields_[n + 1].b.data());
        transfer(kernels_.shellProlong, n, fields_[n + 1].x.data(), at.x.data());
        smooth(n, b, {.layout = level.layout, .colour = 1}, nullptr);
    }

    /// \param residual  where what is left is put; null: nowhere
    void smooth(std::size_t n, const float* b, ShellPush push, float* residual)
    {
        push.halfSweeps = 2 * kSweeps;
        callHost(kernels_.shellSmooth, push, {levels_[n].entries.data(), b, fields_[n].x.data(), residual});
    }

    void transfer(compute::HostKernel kernel, std::size_t n, const float* from, float* to) const
    {
        const auto& tables = levels_[n].tables;
        callHost(kernel, ShellPush{.layout = levels_[n].layout, .coarse = levels_[n + 1].layout},
                 {tables[0].data(), tables[1].data(), tables[2].data(), tables[3].data(), from, to});
    }

    const HostKernels&             kernels_;
    const std::vector<ShellLevel>& levels_;
    const ShellCoarseSolver&       coarse_;
    std::vector<Fields>            fields_;
};

/// Conjugate gradients of one load.
struct Gradients {
    double rz = 0, work = 0;
    double gain = 0, gainBefore = 0; ///< of the last two steps [of work]
    int    steps = 0;
    bool   done = false, converged = false;

    /// Of the work that is missing, from the second step on: steps to come gain as much less as the last one did, but no
    /// less than a tenth of it and 3 % of the step before, because a gain may be small by chance where the matrix is
    /// indefinite. Of 100 shells each with linear, wart, disc and random maps, random curvatures and edges, at tolerances
    /// of 1e-2, 1e-3 and 1e-4, 7 of the 1200 works miss their tolerance's square, six of them on random maps, by up to
    /// five times.
    [[nodiscard]] double estimate() const
    {
        constexpr double kBest = 0.1, kBestOfTwo = 0.03; // gains over those of one and two steps before [1]
        if (work == 0) return 0;
        if (steps < 2) return 1;
        const double last = std::abs(gain), before = std::abs(gainBefore);
        const double missing = std::max(last * std::clamp(last / before, kBest, 1.0), kBestOfTwo * before);
        return std::sqrt(missing / std::abs(work));
    }
};

/// Conjugate gradients: of one load in doubles; of eight in floats, with the operator and all sums in doubles.
template <bool kTogether>
class ShellGradients {
public:
    using Real    = std::conditional_t<kTogether, float, double>;
    using PerLoad = std::array<double, kLoads<kTogether>>;
    using States  = std::array<Gradients, kLoads<kTogether>>;

    ShellGradients(const std::vector<ShellLevel>& levels, const ShellCoarseSolver& coarse, const HostKernels& kernels)
        : kernels_(kernels), finest_(levels.front()), cycle_(levels, coarse, kernels),
          x_(numbersOf(finest_.layout) * kLoads<kTogether>), b_(x_), r_(x_), p_(x_), q_(x_)
    {
    }

    [[nodiscard]] std::vector<Real>&       right() { return b_; }
    [[nodiscard]] const std::vector<Real>& answer() const { return x_; }

    /// \return a state for each load
    States solve(double tolerance, int mostSteps)
    {
        States states{};
        takeStart(states);
        takeFirst(states);
        for (int step = 0; step < mostSteps && !std::ranges::all_of(states, &Gradients::done); ++step) {
            applyToDirection();
            advance(states, tolerance);
            turn(states);
        }
        return states;
    }

private:
    static constexpr double kMostAlpha = 50, kLeastAlpha = 0.02; ///< beyond, a step is one of the cycle alone [1]
    static constexpr double kCalmMost = 4, kCalmLeast = 0.25;    ///< beyond, a step tells nothing of the error [1]

    /// q := K p
    void applyToDirection()
    {
        callHost(kernels_.shellApply, ShellPush{.layout = finest_.layout},
                 {finest_.exact.data(), p_.data(), q_.data()});
    }

    [[nodiscard]] VectorSize size() const { return {std::ptrdiff_t(x_.size()) / kLoads<kTogether>}; }

    PerLoad dots(compute::HostKernel kernel, const Real* a, const void* b) const
    {
        PerLoad sums{};
        callHost(kernel, size(), {a, b, sums.data()});
        return sums;
    }

    /// Returns a vector in floats.
    const std::vector<float>& rounded(const std::vector<Real>& of)
    {
        if constexpr (kTogether) {
            return of;
        } else {
            rounded_.resize(of.size());
            std::ranges::transform(of, rounded_.begin(), [](double number) { return float(number); });
            return rounded_;
        }
    }

    /// z, what a cycle makes of the residual.
    const std::vector<float>& precondition() { return cycle_.precondition(rounded(r_)); }

    /// Takes the answer of nested iteration, and what is left of the right side.
    void takeStart(States& states)
    {
        std::ranges::copy(cycle_.start(rounded(b_)), p_.begin());
        applyToDirection();
        std::ranges::fill(x_, Real(0));
        r_ = b_;
        PerLoad whole{};
        whole.fill(1);
        const auto works = go(whole);
        for (std::size_t n = 0; n < states.size(); ++n) states[n].work = works[n];
    }

    /// x := x + lengths p, r := r - lengths q.
    /// \return (b + r)' x: where x is wrong by e, and r is K e, it lacks e' K e alone
    PerLoad go(const PerLoad& lengths)
    {
        std::array<PerLoad, 2> sums{}; // b' x, r' x
        callHost(kernels_.shellAdvance, size(),
                 {x_.data(), r_.data(), p_.data(), q_.data(), b_.data(), lengths.data(), sums.data()});
        PerLoad works{};
        for (std::size_t n = 0; n < works.size(); ++n) works[n] = sums[0][n] + sums[1][n];
        return works;
    }

    void takeFirst(States& states)
    {
        const std::vector<float>& z = precondition();
        std::ranges::copy(z, p_.begin());
        const PerLoad rz = dots(kernels_.shellDotsOfCycle, r_.data(), z.data());
        for (std::size_t n = 0; n < states.size(); ++n) {
            states[n].rz   = rz[n];
            states[n].done = states[n].converged = rz[n] == 0; // no load
        }
    }

    /// Returns how far each load goes along p. Where that says nothing, p becomes what the cycle alone would do, and q what
    /// belongs to it: the direction that gave such a number is not used at all.
    PerLoad lengths(const States& states)
    {
        const PerLoad pq = dots(kernels_.shellDots, p_.data(), q_.data());
        PerLoad       alphas{};
        bool          anew = false;
        for (std::size_t n = 0; n < states.size(); ++n) {
            if (states[n].done) continue;
            alphas[n]     = states[n].rz / pq[n];
            restarted_[n] = !(std::abs(alphas[n]) < kMostAlpha && std::abs(alphas[n]) > kLeastAlpha);
            if (!restarted_[n]) continue;
            anew      = true;
            alphas[n] = 1;
            for (std::size_t at = n; at < p_.size(); at += states.size()) p_[at] = Real(cycle_.last()[at]);
        }
        if (anew) applyToDirection();
        return alphas;
    }

    /// Goes along p, and judges by what the work of the load has gained.
    void advance(States& states, double tolerance)
    {
        const PerLoad alphas = lengths(states);
        const PerLoad works  = go(alphas);
        for (std::size_t n = 0; n < states.size(); ++n)
            if (!states[n].done) judge(states[n], alphas[n], works[n], restarted_[n], tolerance);
    }

    static void judge(Gradients& state, double alpha, double work, bool restarted, double tolerance)
    {
        state.gainBefore = state.gain;
        state.gain       = restarted ? work - state.work : alpha * state.rz; // the same, but for rounding
        state.work       = work;
        ++state.steps;
        const double size = std::abs(alpha);
        const bool   calm = size > kCalmLeast && size < kCalmMost;
        state.converged   = calm && state.estimate() < tolerance;
        state.done        = state.converged || !std::isfinite(state.work);
    }

    /// Takes the next direction.
    void turn(States& states)
    {
        if (std::ranges::all_of(states, &Gradients::done)) return;
        const std::vector<float>& z  = precondition();
        const PerLoad             rz = dots(kernels_.shellDotsOfCycle, r_.data(), z.data());
        PerLoad                   betas{};
        for (std::size_t n = 0; n < states.size(); ++n) {
            betas[n]     = restarted_[n] || states[n].rz == 0 ? 0 : rz[n] / states[n].rz;
            states[n].rz = rz[n];
        }
        callHost(kernels_.shellTurn, size(), {z.data(), p_.data(), betas.data()});
    }

    const HostKernels&                  kernels_;
    const ShellLevel&                   finest_;
    ShellCycle<kTogether>               cycle_;
    std::vector<Real>                   x_, b_, r_, p_, q_;
    std::vector<float>                  rounded_; ///< of one load
    std::array<bool, kLoads<kTogether>> restarted_{};
};

} // namespace

struct MultigridShellSolver::Impl {
    PlateGrid                              grid{};
    double                                 stiffness = 0, phiUnit = 0; ///< [N/m]; phi over its unknown [N]
    const HostVariant&                     host = hostVariant();
    std::vector<ShellLevel>                levels;
    ShellCoarseSolver                      coarse;
    std::unique_ptr<ShellGradients<false>> alone;    ///< once it is needed
    std::unique_ptr<ShellGradients<true>>  together; ///< the same
    double                                 setUpMilliseconds = 0;

    void prepare(const Shell& shell)
    {
        const auto   began    = std::chrono::steady_clock::now();
        const double rigidity = geometricMean(shell.bending.rigidity.values());
        const bool   sameGrid = shell.bending.grid == grid;
        grid                  = shell.bending.grid;
        stiffness             = rigidity / (grid.spacingX * grid.spacingZ);
        phiUnit               = std::sqrt(rigidity / geometricMean(shell.membraneCompliance.values()));
        makeLevels(shell, *host.kernels, levels);
        coarse.factorise(levels.back(), *host.kernels);
        if (!sameGrid) {
            alone.reset();
            together.reset();
        }
        setUpMilliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
    }

    template <bool kTogether>
    void solve(std::unique_ptr<ShellGradients<kTogether>>& gradients, std::span<const NodeField> forces,
               double tolerance, int mostSteps, std::vector<ShellAnswer>& answers)
    {
        const auto began = std::chrono::steady_clock::now();
        if (!gradients)
            gradients =
                std::make_unique<ShellGradients<kTogether>>(levels, coarse, kTogether ? *host.together : *host.kernels);
        using Real               = typename ShellGradients<kTogether>::Real;
        const ShellLevel&  level = levels.front();
        std::vector<Real>& right = gradients->right();
        std::ranges::fill(right, Real(0));
        eachNode([&](int i, int j, std::size_t node) {
            if (level.exactAt(kInverseW, i, j) == 0) return; // held
            for (std::size_t n = 0; n < forces.size(); ++n)
                right[std::size_t(placeIn(level.layout, i, j, 0) * kLoads<kTogether>) + n] =
                    Real(forces[n].values()[node]);
        });
        const auto   states = gradients->solve(tolerance, mostSteps);
        const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
        for (std::size_t n = 0; n < forces.size(); ++n) {
            answers.push_back(
                {NodeField(grid), NodeField(grid), states[n].work / stiffness, reportOf(states[n], wall)});
            const Real* const x = gradients->answer().data() + n;
            eachNode([&](int i, int j, std::size_t node) {
                answers.back().deflection.values()[node] =
                    double(x[placeIn(level.layout, i, j, 0) * kLoads<kTogether>]) / stiffness;
                answers.back().stressFunction.values()[node] =
                    double(x[placeIn(level.layout, i, j, 1) * kLoads<kTogether>]) * phiUnit / stiffness;
            });
        }
    }

    template <class Visit>
    void eachNode(const Visit& visit) const
    {
        std::size_t node = 0;
        for (int i = 0; i <= grid.cellsX; ++i)
            for (int j = 0; j <= grid.cellsZ; ++j, ++node) visit(i, j, node);
    }

    [[nodiscard]] SolveReport reportOf(const Gradients& state, double wall) const
    {
        constexpr double kStep = 2.3 * (4 * kSweeps / 2 + 2) * 4 / 3; // coupled rows over a plate's; levels [1]
        return {.solver            = "host",
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
    PALP_EXPECT(tolerance > 0 && mostSteps > 0, "a tolerance and a number of steps above 0");
    for (const NodeField& forces : nodalForces) PALP_EXPECT(forces.on(impl_->grid), "forces on another grid");
    std::vector<ShellAnswer> answers;
    constexpr std::size_t    kFewest = 3; // from that many on eight at a time take less time
    while (answers.size() < nodalForces.size()) {
        const auto rest = nodalForces.subspan(answers.size());
        if (rest.size() < kFewest)
            impl_->solve(impl_->alone, rest.first(1), tolerance, mostSteps, answers);
        else
            impl_->solve(impl_->together, rest.first(std::min(rest.size(), std::size_t(kLoadsTogether))), tolerance,
                         mostSteps, answers);
    }
    return answers;
}

} // namespace palp
