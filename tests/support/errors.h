#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "engine/core/grid.h"

// How far off results are. std::max(most, NaN) is `most`: to such a maximum what is no number agrees with everything.
// Here it is infinitely far off.

namespace palp {

/// Returns the larger of `most` and the size of `error`; infinity if `error` is not finite.
[[nodiscard]] inline double worse(double most, double error)
{
    return std::isfinite(error) ? std::max(most, std::abs(error)) : std::numeric_limits<double>::infinity();
}

/// Returns the size of the largest value; infinity if one is not finite.
[[nodiscard]] inline double largest(std::span<const double> values)
{
    double most = 0;
    for (const double value : values) most = worse(most, value);
    return most;
}
[[nodiscard]] inline double largest(const NodeField& field)
{
    return largest(field.values());
}

/// Returns the largest difference over the truth's largest value [1], or as it is where the truth is zero everywhere;
/// infinity if a value is not finite.
[[nodiscard]] inline double errorOf(const NodeField& found, const NodeField& truth)
{
    PALP_EXPECT(found.nodesX() == truth.nodesX() && found.nodesZ() == truth.nodesZ(), "the fields have two grids");
    double most = 0;
    for (std::size_t n = 0; n < truth.values().size(); ++n) most = worse(most, found.values()[n] - truth.values()[n]);
    const double size = largest(truth);
    return size > 0 && std::isfinite(most) ? most / size : most;
}

} // namespace palp
