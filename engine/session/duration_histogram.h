#pragma once
#include <array>
#include <cstdint>

namespace palp {

/// The distribution of a duration: counts and sums in bins of 1/32 octave. A quantile is the mean of its bin: right to
/// 2.2 %, and exact where all are alike.
/// \thread one at a time; add() neither allocates nor waits
class DurationHistogram {
public:
    void add(double seconds) noexcept;

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    [[nodiscard]] double        most() const noexcept { return most_; } ///< exactly [s]; 0 if there is none

    /// Returns the mean of the bin that holds the share, 0.999 for example [s]. 0 if there is none.
    [[nodiscard]] double quantile(double share) const noexcept;

private:
    static constexpr int    kPerOctave = 32;
    static constexpr int    kOctaves   = 28;
    static constexpr double kLeast     = 50e-9; ///< of the first bin but the one below [s]; the last ends at 13 s

    struct Bin {
        std::uint64_t count = 0;
        double        sum   = 0; ///< [s]
    };
    std::array<Bin, kOctaves * kPerOctave + 2> bins_{};
    std::uint64_t                              count_ = 0;
    double                                     most_  = 0;
};

} // namespace palp
