#include "engine/plate/multigrid/multigrid_shell_solver.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "compute_shaders/shared/transfer_layout.h"
#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/plate/multigrid/detail/shell_level.h"

namespace palp {
namespace {

constexpr int kSweeps = 2; ///< in red and black, before and after the coarser levels

/// Fields of one level for some loads.
struct ShellFields {
    std::vector<double> x, b, r; ///< answer, right side, and what is left of it
};

/// The numbers of all loads at one place: of eight as a vector, which compilers keep in registers.
template <int Loads>
struct At {
    typedef double Numbers __attribute__((vector_size(sizeof(double) * Loads), aligned(sizeof(double)), may_alias));
};
template <>
struct At<1> {
    using Numbers = double;
};
template <int Loads>
using Numbers = typename At<Loads>::Numbers;

template <int Loads>
const Numbers<Loads>& numbersAt(const double* place)
{
    return *reinterpret_cast<const Numbers<Loads>*>(place);
}
template <int Loads>
Numbers<Loads>& numbersAt(double* place)
{
    return *reinterpret_cast<Numbers<Loads>*>(place);
}

/// One number for each load.
template <int Loads>
using PerLoad = std::array<double, Loads>;

/// One level with the distances of its columns in memory.
template <int Loads>
class LevelOperator {
public:
    explicit LevelOperator(const ShellLevel& level) : level_(level)
    {
        for (std::size_t n = 0; n < kPlateSteps.size(); ++n) plate_[n] = distance(kPlateSteps[n]);
        for (std::size_t n = 0; n < kCouplingSteps.size(); ++n) coupling_[n] = distance(kCouplingSteps[n]);
    }

    /// Calls visit(node, place in the fields) for every node, or those of one colour.
    template <class Visit>
    void each(Visit&& visit) const
    {
        const ShellLayout& l = level_.layout;
        for (int i = 0; i <= l.cellsX; ++i)
            for (int j = 0; j <= l.cellsZ; ++j) visit(rowAt(i, j), place(i, j));
    }
    template <class Visit>
    void eachOf(int colour, Visit&& visit) const
    {
        const ShellLayout& l = level_.layout;
        for (int i = 0; i <= l.cellsX; ++i)
            for (int j = (i + colour) % 2; j <= l.cellsZ; j += 2) visit(rowAt(i, j), place(i, j));
    }

    /// Subtracts the two rows of a node, times x.
    [[gnu::always_inline]] void subtract(std::size_t node, const double* x, Numbers<Loads>& w, Numbers<Loads>& f) const
    {
        const ShellRow& row = level_.rows[node];
        for (std::size_t n = 0; n < kPlateSteps.size(); ++n) {
            w -= row.w[n] * numbersAt<Loads>(x + plate_[n]);
            f += row.f[n] * numbersAt<Loads>(x + plate_[n] + Loads);
        }
        for (std::size_t n = 0; n < kCouplingSteps.size(); ++n) {
            w -= row.wf[n] * numbersAt<Loads>(x + coupling_[n] + Loads);
            f -= row.fw[n] * numbersAt<Loads>(x + coupling_[n]);
        }
    }

    /// r := b - K x; K x alone, with the opposite sign, for b of null.
    void residual(const double* b, const double* x, double* r) const
    {
        each([&](std::size_t node, std::ptrdiff_t at) {
            Numbers<Loads> w{}, f{};
            if (b != nullptr) {
                w = numbersAt<Loads>(b + at);
                f = numbersAt<Loads>(b + at + Loads);
            }
            subtract(node, x + at, w, f);
            numbersAt<Loads>(r + at)         = w;
            numbersAt<Loads>(r + at + Loads) = f;
        });
    }

    /// Relaxes the nodes of one colour, from values of before the half sweep.
    void relax(int colour, const double* b, double* x, double* changes) const
    {
        eachOf(colour, [&](std::size_t node, std::ptrdiff_t at) {
            Numbers<Loads> w = numbersAt<Loads>(b + at), f = numbersAt<Loads>(b + at + Loads);
            subtract(node, x + at, w, f);
            const ShellNodeInverse& inverse        = level_.inverses[node];
            numbersAt<Loads>(changes + at)         = inverse.ww * w + inverse.wf * f;
            numbersAt<Loads>(changes + at + Loads) = inverse.wf * w + inverse.ff * f;
        });
        eachOf(colour, [&](std::size_t, std::ptrdiff_t at) {
            for (int n = 0; n < 2 * Loads; ++n) x[at + n] += changes[at + n];
        });
    }

private:
    [[nodiscard]] std::ptrdiff_t distance(NodeStep step) const
    {
        return (step.i * level_.layout.stride() + step.j) * 2 * Loads;
    }
    [[nodiscard]] std::size_t rowAt(int i, int j) const
    {
        return std::size_t(i) * std::size_t(level_.layout.cellsZ + 1) + std::size_t(j);
    }
    [[nodiscard]] std::ptrdiff_t place(int i, int j) const { return level_.layout.at(i, j) * 2 * Loads; }

    const ShellLevel&                                      level_;
    std::array<std::ptrdiff_t, ShellRow::kPlateEntries>    plate_{};
    std::array<std::ptrdiff_t, ShellRow::kCouplingEntries> coupling_{};
};

/// Transfers of both fields between a level and the next coarser one; the tables are those of the plate's kernels.
template <int Loads>
class LevelTransfer {
public:
    LevelTransfer(const ShellLevel& fine, const ShellLevel& coarse)
        : fine_(fine), coarse_(coarse),
          between_(std::size_t(fine.layout.cellsX + 1) * std::size_t(fine.layout.cellsZ + 1) * std::size_t(Loads))
    {
    }

    /// Adds the coarse level's answer to the fine one's.
    void prolong(const double* coarse, double* fine)
    {
        for (const int field : {0, 1}) {
            const float *tableX = tablesX(field), *tableZ = tablesZ(field);
            const int    fineX = fine_.layout.cellsX, fineZ = fine_.layout.cellsZ, coarseZ = coarse_.layout.cellsZ;
            for (int i = 0; i <= fineX; ++i)
                for (int j = 0; j <= coarseZ; ++j)
                    sum(tableX + shared::kFineStride * i, shared::kFineWeights, kNoLast, between(i, j, coarseZ),
                        [&](int m) { return coarse + placeIn(coarse_, m, j, field); });
            for (int i = 0; i <= fineX; ++i)
                for (int j = 0; j <= fineZ; ++j)
                    sum(
                        tableZ + shared::kFineStride * j, shared::kFineWeights, kNoLast,
                        fine + placeIn(fine_, i, j, field), [&](int m) { return between(i, m, coarseZ); }, true);
        }
    }

    /// Sets the coarse level's right side.
    void restrict(const double* fine, double* coarse)
    {
        for (const int field : {0, 1}) {
            const int    fineX = fine_.layout.cellsX, fineZ = fine_.layout.cellsZ;
            const float *tableX = tablesX(field) + shared::kFineStride * (fineX + 1),
                        *tableZ = tablesZ(field) + shared::kFineStride * (fineZ + 1);
            for (int i = 0; i <= coarse_.layout.cellsX; ++i)
                for (int j = 0; j <= fineZ; ++j)
                    sum(tableX + shared::kCoarseStride * i, shared::kCoarseWeights, fineX, between(i, j, fineZ),
                        [&](int m) { return fine + placeIn(fine_, m, j, field); });
            for (int i = 0; i <= coarse_.layout.cellsX; ++i)
                for (int j = 0; j <= coarse_.layout.cellsZ; ++j)
                    sum(tableZ + shared::kCoarseStride * j, shared::kCoarseWeights, fineZ,
                        coarse + placeIn(coarse_, i, j, field), [&](int m) { return between(i, m, fineZ); });
        }
    }

private:
    static constexpr int kNoLast = std::numeric_limits<int>::max();

    /// Sums weighted nodes of one entry of a table; nodes beyond the last one have no weight.
    template <class Place>
    static void sum(const float* entry, int weights, int last, double* to, const Place& place, bool add = false)
    {
        Numbers<Loads> all{};
        if (add) all = numbersAt<Loads>(to);
        const int first = int(entry[0]);
        for (int m = 0; m < weights; ++m)
            if (entry[1 + m] != 0) all += double(entry[1 + m]) * numbersAt<Loads>(place(std::min(first + m, last)));
        numbersAt<Loads>(to) = all;
    }

    [[nodiscard]] const float* tablesX(int field) const
    {
        return (field == 0 ? fine_.tableX : fine_.stressTableX).data();
    }
    [[nodiscard]] const float* tablesZ(int field) const
    {
        return (field == 0 ? fine_.tableZ : fine_.stressTableZ).data();
    }
    [[nodiscard]] static std::ptrdiff_t placeIn(const ShellLevel& level, int i, int j, int field)
    {
        return (level.layout.at(i, j) * 2 + field) * Loads;
    }
    double* between(int i, int j, int cellsZ)
    {
        return between_.data() + (std::ptrdiff_t(i) * (cellsZ + 1) + j) * Loads;
    }

    const ShellLevel&   fine_;
    const ShellLevel&   coarse_;
    std::vector<double> between_;
};

/// One symmetric V cycle for some loads.
template <int Loads>
class ShellCycle {
public:
    ShellCycle(const std::vector<ShellLevel>& levels, const ShellCoarseSolver& coarse) : coarse_(coarse)
    {
        for (std::size_t n = 0; n < levels.size(); ++n) {
            const std::size_t numbers = levels[n].layout.nodes() * 2 * Loads;
            fields_.push_back(
                {std::vector<double>(numbers), std::vector<double>(numbers), std::vector<double>(numbers)});
            operators_.emplace_back(levels[n]);
            if (n > 0) transfers_.emplace_back(levels[n - 1], levels[n]);
        }
    }

    [[nodiscard]] const LevelOperator<Loads>& finest() const { return operators_.front(); }
    [[nodiscard]] std::vector<double>&        right() { return fields_.front().b; }

    /// Returns about K^-1 right(); the same symmetric matrix at each call.
    const std::vector<double>& precondition()
    {
        cycle(0);
        return fields_.front().x;
    }

private:
    void cycle(std::size_t n)
    {
        ShellFields& at = fields_[n];
        if (n + 1 == fields_.size()) return coarse_.solve(at.b.data(), at.x.data(), Loads);
        std::ranges::fill(at.x, 0.0);
        for (int sweep = 0; sweep < 2 * kSweeps; ++sweep)
            operators_[n].relax(sweep % 2, at.b.data(), at.x.data(), at.r.data());
        operators_[n].residual(at.b.data(), at.x.data(), at.r.data());
        transfers_[n].restrict(at.r.data(), fields_[n + 1].b.data());
        cycle(n + 1);
        transfers_[n].prolong(fields_[n + 1].x.data(), at.x.data());
        for (int sweep = 0; sweep < 2 * kSweeps; ++sweep)
            operators_[n].relax(1 - sweep % 2, at.b.data(), at.x.data(), at.r.data());
    }

    const ShellCoarseSolver&          coarse_;
    std::vector<ShellFields>          fields_;
    std::vector<LevelOperator<Loads>> operators_;
    std::vector<LevelTransfer<Loads>> transfers_;
};

/// Conjugate gradients of one load.
struct Gradients {
    double rz = 0, work = 0;
    double gain = 0, gainBefore = 0; ///< of the last two steps [of work]
    int    steps = 0;
    bool   done = false, converged = false;

    [[nodiscard]] double estimate() const
    {
        return work != 0 ? std::sqrt((std::abs(gain) + std::abs(gainBefore)) / std::abs(work)) : 0;
    }
};

template <int Loads>
class ShellGradients {
public:
    ShellGradients(const std::vector<ShellLevel>& levels, const ShellCoarseSolver& coarse)
        : cycle_(levels, coarse), x_(cycle_.right().size()), b_(x_), r_(x_), p_(x_), q_(x_)
    {
    }

    [[nodiscard]] std::vector<double>&       right() { return b_; }
    [[nodiscard]] const std::vector<double>& answer() const { return x_; }

    /// \return a state for each load
    std::array<Gradients, Loads> solve(double tolerance, int mostSteps)
    {
        std::array<Gradients, Loads> states{};
        std::ranges::fill(x_, 0.0);
        r_ = b_;
        takeFirst(states);
        for (int step = 0; step < mostSteps && !std::ranges::all_of(states, &Gradients::done); ++step) {
            cycle_.finest().residual(nullptr, p_.data(), q_.data()); // - K p
            advance(states, tolerance);
            turn(states);
        }
        return states;
    }

private:
    static constexpr double kMostAlpha = 50, kLeastAlpha = 0.02; ///< beyond, a step is one of the cycle alone [1]
    static constexpr double kCalmMost = 4, kCalmLeast = 0.25;    ///< beyond, a step tells nothing of the error [1]

    [[nodiscard]] static PerLoad<Loads> dots(const std::vector<double>& a, const std::vector<double>& b)
    {
        PerLoad<Loads> sums{};
        Numbers<Loads> all{};
        for (std::size_t at = 0; at < a.size(); at += Loads)
            all += numbersAt<Loads>(a.data() + at) * numbersAt<Loads>(b.data() + at);
        numbersAt<Loads>(sums.data()) = all;
        return sums;
    }

    /// to := to + factors of
    static void addTimes(std::vector<double>& to, const PerLoad<Loads>& factors, const std::vector<double>& of)
    {
        const Numbers<Loads> by = numbersAt<Loads>(factors.data());
        for (std::size_t at = 0; at < to.size(); at += Loads)
            numbersAt<Loads>(to.data() + at) += by * numbersAt<Loads>(of.data() + at);
    }

    void takeFirst(std::array<Gradients, Loads>& states)
    {
        cycle_.right()          = r_;
        p_                      = cycle_.precondition();
        const PerLoad<Loads> rz = dots(r_, p_);
        for (std::size_t n = 0; n < states.size(); ++n) {
            states[n].rz   = rz[n];
            states[n].done = states[n].converged = rz[n] == 0; // no load
        }
    }

    /// Goes along p, and judges by what the work of the load has gained.
    void advance(std::array<Gradients, Loads>& states, double tolerance)
    {
        const PerLoad<Loads> pq = dots(p_, q_);
        PerLoad<Loads>       alphas{};
        for (std::size_t n = 0; n < states.size(); ++n) {
            const double alpha = states[n].rz / -pq[n], size = std::abs(alpha);
            restarted_[n] = !(size < kMostAlpha && size > kLeastAlpha);
            if (!states[n].done) alphas[n] = restarted_[n] ? 1 : alpha;
        }
        addTimes(x_, alphas, p_);
        addTimes(r_, alphas, q_);
        // (b + r)' x: where x is wrong by e, and r is K e, it lacks e' K e alone.
        const PerLoad<Loads> bx = dots(b_, x_), rx = dots(r_, x_);
        for (std::size_t n = 0; n < states.size(); ++n) {
            Gradients& state = states[n];
            if (state.done) continue;
            state.gainBefore = state.gain;
            state.gain =
                restarted_[n] ? bx[n] + rx[n] - state.work : alphas[n] * state.rz; // the same, but for rounding
            state.work = bx[n] + rx[n];
            ++state.steps;
            const double size = std::abs(alphas[n]);
            const bool   calm = size > kCalmLeast && size < kCalmMost;
            state.converged   = state.steps > 1 && calm && state.estimate() < tolerance;
            state.done        = state.converged || !std::isfinite(state.work);
        }
    }

    /// Takes the next direction.
    void turn(std::array<Gradients, Loads>& states)
    {
        if (std::ranges::all_of(states, &Gradients::done)) return;
        cycle_.right()                = r_;
        const std::vector<double>& z  = cycle_.precondition();
        const PerLoad<Loads>       rz = dots(r_, z);
        PerLoad<Loads>             betas{};
        for (std::size_t n = 0; n < states.size(); ++n) {
            betas[n]     = restarted_[n] || states[n].rz == 0 ? 0 : rz[n] / states[n].rz;
            states[n].rz = rz[n];
        }
        const Numbers<Loads> by = numbersAt<Loads>(betas.data());
        for (std::size_t at = 0; at < p_.size(); at += Loads)
            numbersAt<Loads>(p_.data() + at) = numbersAt<Loads>(z.data() + at) + by * numbersAt<Loads>(p_.data() + at);
    }

    ShellCycle<Loads>       cycle_;
    std::vector<double>     x_, b_, r_, p_, q_;
    std::array<bool, Loads> restarted_{};
};

} // namespace

struct MultigridShellSolver::Impl {
    static constexpr int kTogether = 8;

    PlateGrid                                  grid;
    double                                     stiffness, phiUnit; ///< [N/m]; phi over its unknown [N]
    std::vector<ShellLevel>                    levels;
    ShellCoarseSolver                          coarse;
    std::unique_ptr<ShellGradients<1>>         alone;    ///< once it is needed
    std::unique_ptr<ShellGradients<kTogether>> together; ///< the same
    double                                     setUpMilliseconds = 0;

    explicit Impl(const Shell& shell)
        : grid(shell.bending.grid),
          stiffness(geometricMean(shell.bending.rigidity.values()) / (grid.spacingX * grid.spacingZ)),
          phiUnit(std::sqrt(geometricMean(shell.bending.rigidity.values()) /
                            geometricMean(shell.membraneCompliance.values()))),
          levels(shellLevels(shell)), coarse(levels.back())
    {
    }

    template <int Loads>
    void solve(std::unique_ptr<ShellGradients<Loads>>& gradients, std::span<const NodeField> forces, double tolerance,
               int mostSteps, std::vector<ShellAnswer>& answers)
    {
        const auto began = std::chrono::steady_clock::now();
        if (!gradients) gradients = std::make_unique<ShellGradients<Loads>>(levels, coarse);
        const ShellLevel&    level = levels.front();
        std::vector<double>& right = gradients->right();
        std::ranges::fill(right, 0.0);
        eachNode([&](int i, int j, std::size_t node) {
            if (level.inverses[node].ww == 0) return; // held
            for (std::size_t n = 0; n < forces.size(); ++n)
                right[std::size_t(level.layout.at(i, j) * 2 * Loads) + n] = forces[n].values()[node];
        });
        const auto   states = gradients->solve(tolerance, mostSteps);
        const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
        for (std::size_t n = 0; n < forces.size(); ++n) {
            answers.push_back(
                {NodeField(grid), NodeField(grid), states[n].work / stiffness, reportOf(states[n], wall)});
            eachNode([&](int i, int j, std::size_t node) {
                const double* at = gradients->answer().data() + level.layout.at(i, j) * 2 * Loads + std::ptrdiff_t(n);
                answers.back().deflection.values()[node]     = at[0] / stiffness;
                answers.back().stressFunction.values()[node] = at[Loads] * phiUnit / stiffness;
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

MultigridShellSolver::MultigridShellSolver(const Shell& shell)
{
    const auto began = std::chrono::steady_clock::now();
    if (const auto why = whyUnsolvable(shell)) throw Error("the shell cannot be solved: " + *why);
    impl_ = std::make_unique<Impl>(shell);
    impl_->setUpMilliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
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
            impl_->solve(impl_->together, rest.first(std::min(rest.size(), std::size_t(Impl::kTogether))), tolerance,
                         mostSteps, answers);
    }
    return answers;
}

} // namespace palp
