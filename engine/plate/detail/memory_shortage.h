#pragma once
#include <algorithm>
#include <cstddef>

namespace palp {

/// Remembers how much did not fit a memory, and when to try again: another program may have filled it for a while.
/// \thread one at a time
class MemoryShortage {
public:
    /// Returns how much may be tried now: less than what did not fit, but now and then everything.
    [[nodiscard]] std::size_t most() noexcept
    {
        if (tooMuch_ == kNothing || left_-- > 0) return tooMuch_ - 1;
        left_ = 0; // until foundAt() or fitted() says how that went
        return kNothing - 1;
    }

    /// Takes note that this much did not fit. After each failure in turn it takes twice as long until the next trial.
    void foundAt(std::size_t amount) noexcept
    {
        tooMuch_ = std::min(tooMuch_, amount);
        left_    = wait_;
        wait_    = std::min(2 * wait_, kLongest);
    }

    /// Takes note that this much fits.
    void fitted(std::size_t amount) noexcept
    {
        if (amount >= tooMuch_) *this = {};
    }

private:
    static constexpr std::size_t kNothing = std::size_t(-1);   ///< is too much
    static constexpr int         kFirst = 64, kLongest = 4096; ///< calls of most(): one second, and one minute at 60 Hz

    std::size_t tooMuch_ = kNothing;
    int         wait_ = kFirst, left_ = 0; ///< calls of most()
};

} // namespace palp
