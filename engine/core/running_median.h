#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace palp {

/// The median of the last `Most` values: a few wild ones do not move it, unlike a mean.
/// \thread one; allocates nothing
template <std::size_t Most>
class RunningMedian {
public:
    /// Adds a finite value; the oldest is forgotten once there are `Most`.
    void add(double value) noexcept
    {
        const auto begin = sorted_.begin();
        if (count_ == Most) {
            const auto oldest = std::lower_bound(begin, begin + std::ptrdiff_t(count_), past_[next_]);
            std::copy(oldest + 1, begin + std::ptrdiff_t(count_), oldest);
            --count_;
        }
        const auto place = std::upper_bound(begin, begin + std::ptrdiff_t(count_), value);
        std::copy_backward(place, begin + std::ptrdiff_t(count_), begin + std::ptrdiff_t(count_ + 1));
        *place       = value;
        past_[next_] = value;
        next_        = (next_ + 1) % Most;
        ++count_;
    }

    /// Returns the median, of an even number the upper one of the middle two; `none` before the first value.
    [[nodiscard]] double value(double none) const noexcept { return count_ > 0 ? sorted_[count_ / 2] : none; }

private:
    std::array<double, Most> past_{}, sorted_{}; ///< a ring by age; the same values by size
    std::size_t              next_ = 0, count_ = 0;
};

} // namespace palp
