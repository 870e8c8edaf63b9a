#pragma once
#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

#include "engine/plate/multigrid/detail/host_call.h"
#include "engine/plate/multigrid/detail/shell_level.h"

namespace palp {

inline constexpr int kShellSweeps = 2; ///< in red and black, before and after the coarser levels

/// The kernels for one load, or for eight side by side.
template <bool kTogether>
inline constexpr int kLoads = kTogether ? kLoadsTogether : 1;

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
    /// Gives the answer of the last precondition() or start() away, for memory of the same size that is 0 where nothing
    /// moves.
    void giveLast(std::vector<float>& to) { fields_.front().x.swap(to); }
    void giveStart(std::vector<float>& to) { fields_.front().guess.swap(to); }

    /// Returns an answer by nested iteration: that of the coarsest level, refined, and on each level between improved
    /// by one cycle alone. (A step of conjugate gradients there may break down.)
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
        push.halfSweeps = 2 * kShellSweeps;
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

/// Vectors of conjugate gradients on the host: of one load in doubles; of eight in floats, with the operator, but for
/// steepness(), and all sums in doubles.
template <bool kTogether>
class HostShellFields {
public:
    using Real    = std::conditional_t<kTogether, float, double>;
    using PerLoad = std::array<double, kLoads<kTogether>>;

    HostShellFields(const std::vector<ShellLevel>& levels, const ShellCoarseSolver& coarse, const HostKernels& kernels)
        : kernels_(kernels), finest_(levels.front()), cycle_(levels, coarse, kernels),
          x_(numbersOf(finest_.layout) * kLoads<kTogether>), b_(x_), r_(x_), p_(x_), q_(x_)
    {
    }

    void setRight(std::span<const PlacedLoad> loads)
    {
        std::ranges::fill(b_, Real(0));
        for (std::size_t n = 0; n < loads.size(); ++n)
            for (const auto& [place, force] : loads[n]) b_[std::size_t(place * kLoads<kTogether>) + n] = Real(force);
    }
    [[nodiscard]] double answer(std::size_t load, std::ptrdiff_t place) const
    {
        return double(x_[std::size_t(place * kLoads<kTogether>) + load]);
    }

    [[nodiscard]] PerLoad none() const { return {}; }

    /// Takes the answer of nested iteration, and what is left of the right side.
    /// \return as go()
    PerLoad takeStart()
    {
        const ShellPush push{.layout = finest_.layout};
        const auto&     start = cycle_.start(rounded(b_));
        PerLoad         works{};
        if constexpr (kTogether) {
            cycle_.giveStart(x_);
            callHost(kernels_.shellMissing, push,
                     {finest_.exact.data(), b_.data(), x_.data(), r_.data(), works.data()});
        } else {
            std::ranges::copy(start, x_.begin());
            callHost(kernels_.shellMissing, push, {finest_.exact.data(), b_.data(), x_.data(), r_.data()});
            works[0] = dots(kernels_.shellDots, b_, x_.data())[0] + dots(kernels_.shellDots, r_, x_.data())[0];
        }
        return works;
    }

    /// z := what a cycle makes of what is left.
    /// \return r' z
    PerLoad precondition() { return dots(kernels_.shellDotsOfCycle, r_, cycle_.precondition(rounded(r_)).data()); }

    /// q := K p
    /// \return p' q
    PerLoad useDirection() { return apply(); }

    /// Returns p' K p by K in floats, in half the time, and leaves q.
    PerLoad steepness() requires kTogether
    {
        PerLoad sums{};
        callHost(kernels_.shellSteepness, ShellPush{.layout = finest_.layout},
                 {finest_.entries.data(), p_.data(), sums.data()});
        return sums;
    }

    /// Of these loads p := z; then q := K p.
    void restart(const PerLoad& which)
    {
        if (isOfCycle_) return; // p is z
        for (std::size_t n = 0; n < which.size(); ++n)
            for (std::size_t at = n; which[n] != 0 && at < p_.size(); at += which.size())
                p_[at] = Real(cycle_.last()[at]);
        apply();
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

    /// x := x + lengths p, which ends it: r is left as it was.
    void finish(const PerLoad& lengths) requires kTogether
    {
        callHost(kernels_.shellTurn, size(), {x_.data(), p_.data(), lengths.data()});
        x_.swap(p_);
    }

    /// p := z
    void takeDirection()
    {
        if constexpr (kTogether)
            cycle_.giveLast(p_);
        else
            std::ranges::copy(cycle_.last(), p_.begin());
        isOfCycle_ = true;
    }
    /// p := z + betas p
    void turn(const PerLoad& betas)
    {
        callHost(kernels_.shellTurn, size(), {cycle_.last().data(), p_.data(), betas.data()});
        isOfCycle_ = false;
    }

private:
    /// q := K p
    /// \return p' q
    PerLoad apply()
    {
        PerLoad         sums{};
        const ShellPush push{.layout = finest_.layout};
        if constexpr (kTogether) {
            callHost(kernels_.shellApply, push, {finest_.exact.data(), p_.data(), q_.data(), sums.data()});
        } else {
            callHost(kernels_.shellApply, push, {finest_.exact.data(), p_.data(), q_.data()});
            sums = dots(kernels_.shellDots, p_, q_.data());
        }
        return sums;
    }

    [[nodiscard]] VectorSize size() const { return {std::ptrdiff_t(x_.size()) / kLoads<kTogether>}; }

    PerLoad dots(compute::HostKernel kernel, const std::vector<Real>& a, const void* b) const
    {
        PerLoad sums{};
        callHost(kernel, size(), {a.data(), b, sums.data()});
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

    const HostKernels&    kernels_;
    const ShellLevel&     finest_;
    ShellCycle<kTogether> cycle_;
    std::vector<Real>     x_, b_, r_, p_, q_;
    std::vector<float>    rounded_;           ///< of one load
    bool                  isOfCycle_ = false; ///< p is the first direction, z
};

} // namespace palp
