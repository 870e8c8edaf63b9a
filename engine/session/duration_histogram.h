#pragma once
#include <array>
#include <cstdint>

namespace palp {

/// The distribution of a duration: counts in bins of 1/32 octave, so that quantiles are right to 2.2 %.
/// \thread one at a time; add() neither allocates nor waits
class DurationHistogram {
public:
    void add(double seconds) noexcept;

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] double        most() const noexcept { return most_; } ///< exactly [s]; 0 if there is none

    /// Returns the upper end of the bin that holds the share, 0.999 for example [s]; that of the last bins is at most
    /// most(). 0 if there is none.
    [[nodiscard]] double quantile(double share) const noexcept;

private:
    static constexpr int    kPerOctave = 32;
    static constexpr int    kOctaves   = 28;
    static constexpr double kLeast     = 50e-9; ///< of the first bin but the one below [s]; the last ends at 13 s

    std::array<std::uint64_t, kOctaves * kPerOctave + 2> bins_{};
    std::uint64_t                                        count_ = 0;
    double                                               most_  = 0;
};

} // namespace palp
