#pragma once
#include <algorithm>
#include <cmath>
#include <span>

namespace palp {

/// Returns the largest of the values and 0; NaN, which is the worst, if any of them is NaN.
[[nodiscard]] inline double worstOf(std::span<const double> values)
{
    double most = 0;
    for (const double value : values) {
        if (std::isnan(value)) return value;
        most = std::max(most, value);
    }
    return most;
}

} // namespace palp
