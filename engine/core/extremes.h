#pragma once
#include <span>

namespace palp {

/// The extremes of a set of values.
struct Extremes {
    double least, most; ///< meaningless unless finite
    bool   finite;      ///< whether all values are finite numbers
};

/// Returns the geometric mean of positive values; NaN if there are none.
[[nodiscard]] double geometricMean(std::span<const double> values) noexcept;

/// Returns the least and the largest of values; infinity and minus infinity if there are none. It is as fast as memory,
/// because every deformation checks its fields.
[[nodiscard]] Extremes extremesOf(std::span<const double> values) noexcept;

} // namespace palp
