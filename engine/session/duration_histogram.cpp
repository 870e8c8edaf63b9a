#include "engine/session/duration_histogram.h"

#include <algorithm>
#include <cmath>

namespace palp {

void DurationHistogram::add(double seconds) noexcept
{
    const double octaves = seconds > kLeast ? std::log2(seconds / kLeast) : 0;
    const auto   bin     = seconds > kLeast ? 1 + std::int64_t(std::min(octaves, double(kOctaves)) * kPerOctave) : 0;
    ++bins_[std::size_t(bin)].count;
    bins_[std::size_t(bin)].sum += seconds > 0 ? seconds : 0;
    ++count_;
    most_ = std::max(most_, seconds);
}

double DurationHistogram::quantile(double share) const noexcept
{
    if (count_ == 0) return 0;
    const auto    wanted = std::uint64_t(std::ceil(std::clamp(share, 0.0, 1.0) * double(count_)));
    std::uint64_t sum    = 0;
    for (const Bin& bin : bins_) {
        sum += bin.count;
        if (sum >= wanted && bin.count > 0) return std::min(most_, bin.sum / double(bin.count));
    }
    return most_;
}

} // namespace palp
