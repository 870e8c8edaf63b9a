#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/session/tick_record.h"

namespace palp {

/// The last seconds of a session, for curves: the extremes of every hundredth of a second, and how long ticks took.
/// \thread one
class TouchHistory {
public:
    static constexpr double      kStep     = 0.01;                    ///< of a point of a curve [s]
    static constexpr std::size_t kSteps    = 600;                     ///< of a curve: six seconds
    static constexpr std::size_t kBins     = 40;                      ///< of the histogram of periods
    static constexpr double      kShortest = 0.5e-3, kLongest = 8e-3; ///< its ends, on a logarithmic scale [s]

    /// Adds each record of a session, in order. A time that goes back is a new session: the earlier one is forgotten.
    void add(const TickRecord& record) noexcept;
    void clear() noexcept { *this = {}; }

    /// Return equally many values, oldest first; the last is the newest whole step.
    [[nodiscard]] std::span<const float> forces() const noexcept
    {
        return {forces_.data() + kSteps - count_, count_};
    } ///< largest in a step [N]
    [[nodiscard]] std::span<const float> depths() const noexcept
    {
        return {depths_.data() + kSteps - count_, count_};
    } ///< of the hand below the proxy, largest in a step [m]

    /// Returns the ticks per bin of their period, from kShortest to kLongest; others are in the end bins.
    [[nodiscard]] std::span<const float> periods() const noexcept { return periods_; }
    [[nodiscard]] std::uint64_t          ticks() const noexcept { return ticks_; }
    [[nodiscard]] const TickRecord&      newest() const noexcept { return newest_; }

private:
    std::array<float, kSteps> forces_{}, depths_{}; // [N], [m]; filled from the end
    std::array<float, kBins>  periods_{};
    std::size_t               count_ = 0;
    std::uint64_t             ticks_ = 0;
    std::int64_t              step_  = -1;            // that is being filled
    float                     force_ = 0, depth_ = 0; // largest in it [N], [m]
    TickRecord                newest_;
};

} // namespace palp
