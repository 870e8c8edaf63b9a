#include "engine/core/extremes.h"

#include <array>
#include <limits>

namespace palp {

Extremes extremesOf(std::span<const double> values) noexcept
{
    constexpr std::size_t     kLanes = 8; // independent of each other, so that compilers make vectors of them
    std::array<double, kLanes> least, most, broken{};
    least.fill(std::numeric_limits<double>::infinity());
    most.fill(-std::numeric_limits<double>::infinity());
    const auto take = [&](std::size_t lane, double value) {
        least[lane] = value < least[lane] ? value : least[lane];
        most[lane]  = value > most[lane] ? value : most[lane];
        broken[lane] += value - value; // 0 for finite numbers, or else not a number
    };
    std::size_t n = 0;
    for (; n + kLanes <= values.size(); n += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane) take(lane, values[n + lane]);
    for (; n < values.size(); ++n) take(0, values[n]);

    Extremes all{least[0], most[0], true};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        all.least  = least[lane] < all.least ? least[lane] : all.least;
        all.most   = most[lane] > all.most ? most[lane] : all.most;
        all.finite = all.finite && broken[lane] == 0;
    }
    return all;
}

} // namespace palp
