#include "engine/session/duration_histogram.h"

#include <algorithm>
#include <cmath>

namespace palp {

void DurationHistogram::add(double seconds) noexcept
{
    const double octaves = seconds > kLeast ? std::log2(seconds / kLeast) : 0;
    const auto   bin     = seconds > kLeast ? 1 + std::int64_t(std::min(octaves, double(kOctaves)) * kPerOctave) : 0;
    ++bins_[std::size_t(bin)];
    ++count_;
    most_ = std::max(most_, seconds);
}

double DurationHistogram::quantile(double share) const noexcept
{
    if (count_ == 0) return 0;
    const auto    wanted = std::uint64_t(std::ceil(std::clamp(share, 0.0, 1.0) * double(count_)));
    std::uint64_t sum    = 0;
    for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
        sum += bins_[bin];
        if (sum >= wanted && sum > 0) return std::min(most_, kLeast * std::exp2(double(bin) / kPerOctave));
    }
    return most_;
}

} // namespace palp
