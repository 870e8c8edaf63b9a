#pragma once
#include <span>

namespace palp {

struct Extremes {
    double least, most; ///< meaningless unless finite
    bool   finite;      ///< whether all values are finite numbers
};

/// The least and the largest of values; of none, infinity and minus infinity. As fast as memory: every deformation
/// looks through its fields.
[[nodiscard]] Extremes extremesOf(std::span<const double> values) noexcept;

} // namespace palp
