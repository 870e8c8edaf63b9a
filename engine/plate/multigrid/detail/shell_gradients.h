#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/core/contract.h"

namespace palp {

/// Conjugate gradients of one load.
struct Gradients {
    double rz = 0, work = 0;
    double gain = 0, gainBefore = 0; ///< of the last two steps [of work]
    double missingShare = 1;         ///< of the work, over it, as the first step alone shows [1]
    int    steps        = 0;
    bool   done = false, converged = false;

    /// The root of the work that is missing, over the work [1]. After the first step only missingAfter() knows. Then
    /// steps to come gain as much less as the last one did, but no less than a tenth of it and 3 % of the step before,
    /// because a gain may be small by chance where the matrix is indefinite. Of 100 shells each with linear, wart, disc
    /// and random maps, random curvatures and edges, at tolerances of 1e-2, 1e-3 and 1e-4, 7 of the 1200 works miss
    /// their tolerance's square, six of them on random maps, by up to five times.
    [[nodiscard]] double estimate() const
    {
        constexpr double kBest = 0.1, kBestOfTwo = 0.03; // gains over those of one and two steps before [1]
        if (work == 0) return 0;
        if (steps < 2) return std::sqrt(missingShare);
        const double last = std::abs(gain), before = std::abs(gainBefore);
        const double missing = std::max(last * std::clamp(last / before, kBest, 1.0), kBestOfTwo * before);
        return std::sqrt(missing / std::abs(work));
    }
};

/// Conjugate gradients of the loads of a shell, by vectors on any processor.
/// \tparam Fields  as HostShellFields
template <class Fields>
class ShellGradients {
public:
    using PerLoad = typename Fields::PerLoad;
    using States  = std::vector<Gradients>;

    explicit ShellGradients(Fields& fields) : fields_(fields), restarted_(fields.none()), states_(restarted_.size()) {}

    /// \return a state for each load
    States solve(double tolerance, int mostSteps)
    {
        takeStart();
        takeFirst();
        for (int step = 0; step < mostSteps && !areDone(); ++step) {
            advance(tolerance, step == 0);
            turn();
        }
        return states_;
    }

private:
    static constexpr double kMostAlpha = 50, kLeastAlpha = 0.02; ///< beyond, a step is one of the cycle alone [1]
    static constexpr double kCalmMost = 4, kCalmLeast = 0.25;    ///< beyond, a step tells nothing of the error [1]

    [[nodiscard]] bool areDone() const { return std::ranges::all_of(states_, &Gradients::done); }

    void takeStart()
    {
        const PerLoad works = fields_.takeStart();
        for (std::size_t n = 0; n < states_.size(); ++n) states_[n].work = works[n];
    }

    void takeFirst()
    {
        const PerLoad rz = fields_.precondition();
        fields_.takeDirection();
        for (std::size_t n = 0; n < states_.size(); ++n) {
            states_[n].rz   = rz[n];
            states_[n].done = states_[n].converged = rz[n] == 0; // no load
        }
    }

    /// Returns how far each load goes along p. Where that says nothing, p becomes what the cycle alone would do, and q
    /// what belongs to it: the direction that gave such a number is not used at all.
    PerLoad lengths()
    {
        const PerLoad pq     = fields_.useDirection();
        PerLoad       alphas = fields_.none();
        bool          anew   = false;
        restarted_           = fields_.none();
        for (std::size_t n = 0; n < states_.size(); ++n) {
            if (states_[n].done) continue;
            alphas[n]     = states_[n].rz / pq[n];
            restarted_[n] = std::abs(alphas[n]) < kMostAlpha && std::abs(alphas[n]) > kLeastAlpha ? 0 : 1;
            if (restarted_[n] == 0) continue;
            anew      = true;
            alphas[n] = 1;
        }
        if (anew) fields_.restart(restarted_);
        return alphas;
    }

    /// Goes along p, and judges by what the work of the load has gained.
    void advance(double tolerance, bool first)
    {
        if constexpr (requires { fields_.steepness(); })
            if (endsRoughly(tolerance, first)) return;
        const PerLoad alphas = lengths();
        if constexpr (
            requires { fields_.finish(alphas); } && !requires { fields_.steepness(); })
            if (first && restarted_ == fields_.none() && endsWith(alphas, tolerance, first)) return;
        const PerLoad works = fields_.go(alphas);
        for (std::size_t n = 0; n < states_.size(); ++n)
            if (!states_[n].done) judge(states_[n], alphas[n], works[n], restarted_[n] != 0, tolerance);
    }

    /// Goes along p if all loads end with that. A last step asks for no residual, and its length may be found in
    /// floats, in half the time: the work lacks as much of the gain as the length is wrong, by 3e-6 where it was
    /// compared, at up to 129 nodes a side.
    bool endsRoughly(double tolerance, bool first)
    {
        PerLoad alphas = fields_.none();
        std::ranges::fill(alphas, 1); // about
        if (statesAtEnd(alphas, tolerance, first).empty()) return false;
        const PerLoad pq = fields_.steepness();
        for (std::size_t n = 0; n < states_.size(); ++n) alphas[n] = states_[n].done ? 0 : states_[n].rz / pq[n];
        return endsWith(alphas, tolerance, first);
    }

    bool endsWith(const PerLoad& alphas, double tolerance, bool first)
    {
        States ended = statesAtEnd(alphas, tolerance, first);
        if (ended.empty()) return false;
        fields_.finish(alphas);
        states_ = std::move(ended);
        return true;
    }

    /// Returns the states behind a step of these lengths; none if a load goes on then.
    [[nodiscard]] States statesAtEnd(const PerLoad& alphas, double tolerance, bool first) const
    {
        States       ended   = states_;
        const double missing = first ? missingAfter(alphas) : 0;
        for (std::size_t n = 0; n < ended.size(); ++n) {
            if (ended[n].done) continue;
            if (first) ended[n].missingShare = missing;
            judge(ended[n], alphas[n], ended[n].work + alphas[n] * ended[n].rz, false, tolerance);
            if (!ended[n].converged) return {};
        }
        return ended;
    }

    static bool isCalm(double alpha) { return std::abs(alpha) > kCalmLeast && std::abs(alpha) < kCalmMost; }

    static void judge(Gradients& state, double alpha, double work, bool restarted, double tolerance)
    {
        state.gainBefore = state.gain;
        state.gain       = restarted ? work - state.work : alpha * state.rz; // the same, but for rounding
        state.work       = work;
        ++state.steps;
        state.converged = isCalm(alpha) && state.estimate() < tolerance;
        state.done      = state.converged || !std::isfinite(state.work);
    }

    /// Judges loads that are solved together by what the first step gains for that one for which it gains most: one
    /// gain may be small by chance, but hardly all of three or more. After it 0.2 % of it is missing at the median, and
    /// 2.5 % at the 99th of 100 loads where the map is smooth; where it jumps, so much is gained that hardly anything
    /// stops here.
    ///
    /// Of 11844 loads on shells with constant, linear, bell-shaped and wavy maps and discs, of any edges and curvatures
    /// and with and without a foundation, 1990 stop here at a tolerance of 1e-2, and nine of these miss its square, at
    /// worst by 13 times: as many of a hundred as miss it by estimate().
    ///
    /// \return the share of a work that is missing [1]; infinite where the step tells nothing of it
    [[nodiscard]] double missingAfter(const PerLoad& alphas) const
    {
        constexpr double kMissing = 0.05; // of the gain [1]
        constexpr int    kFewest  = 3;    // loads
        constexpr double kUnknown = std::numeric_limits<double>::infinity();
        double           most     = 0;
        int              loads    = 0;
        for (std::size_t n = 0; n < states_.size(); ++n) {
            if (states_[n].done) continue;
            const double gain = alphas[n] * states_[n].rz;
            if (!isCalm(alphas[n]) || !std::isfinite(gain) || states_[n].work == 0) return kUnknown;
            most = std::max(most, std::abs(gain / states_[n].work));
            ++loads;
        }
        return loads < kFewest ? kUnknown : kMissing * most;
    }

    /// Takes the next direction.
    void turn()
    {
        if (areDone()) return;
        const PerLoad rz    = fields_.precondition();
        PerLoad       betas = fields_.none();
        for (std::size_t n = 0; n < states_.size(); ++n) {
            betas[n] = restarted_[n] != 0 || states_[n].rz == 0 || !std::isfinite(rz[n]) ? 0 : rz[n] / states_[n].rz;
            states_[n].rz = rz[n];
        }
        fields_.turn(betas);
    }

    Fields& fields_;
    PerLoad restarted_; ///< not 0: the last step was one of the cycle alone
    States  states_;
};

} // namespace palp
