#pragma once
#include <algorithm>
#include <utility>

namespace palp {

/// The pace of the deformation in real time, smoothed: how far ahead of the touch a window must be.
class SolvePace {
public:
    /// \param nominal  [s] from one solve to the next
    explicit SolvePace(double nominal) : nominal_(nominal), period_(nominal), solve_(nominal) {}

    /// Notes that a solve begins.
    /// \param now  [s]
    /// \return [s] from now to the middle of the time in which its table will be in use: it is there after a solve, and
    ///         serves for a period. Before the first solve has ended it is taken to need all of its period.
    double begins(double now) noexcept
    {
        if (const double dt = now - last_; hasBegun_ && dt < kLongest)
            period_ += kShare * (std::max(dt, nominal_) - period_);
        hasBegun_ = true;
        last_     = now;
        return solve_ + period_ / 2;
    }

    /// Notes that it took so long [s]. One that took longer than half a second was held up, as by a debugger, unless
    /// the next one takes as long.
    void ended(double took) noexcept
    {
        const bool isLong = took > kLongest;
        if (isLong && !std::exchange(wasLong_, true)) return;
        wasLong_  = isLong;
        solve_    = hasEnded_ ? solve_ + kShare * (took - solve_) : took;
        hasEnded_ = true;
    }

private:
    static constexpr double kShare   = 0.2; ///< of the newest [1]
    static constexpr double kLongest = 0.5; ///< [s] beyond it the hand was away, or the program stopped

    double nominal_, period_, solve_; ///< [s]
    double last_     = 0;             ///< [s] when the last solve began
    bool   hasBegun_ = false, hasEnded_ = false, wasLong_ = false;
};

} // namespace palp
