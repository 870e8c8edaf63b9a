#pragma once
#include <algorithm>
#include <cmath>

#include "engine/core/enum_names.h"

namespace palp {

/// The rule that gives a node its rigidity from the points around it; engine/chart/resample.h has the definitions.
enum class Resampling {
    logMean, ///< exp of the mean of ln D, Gaussian weights: hardly any jitter while the grid slides over the points
    nearest  ///< D of the nearest projected point: the paper's; a step wherever the nearest point changes
};
constexpr auto namesOf(Resampling)
{
    using enum Resampling;
    return std::to_array<NamedValue<Resampling>>({{logMean, "log-mean"}, {nearest, "nearest"}});
}

inline constexpr double kResamplingReach  = 4.0; ///< of the Gaussian; the weight there is 3e-4 [standard deviations]
inline constexpr double kResamplingNearby = 2.5; ///< beyond it a node counts as without a point [standard deviations]

/// Returns the Gaussian's standard deviation [m], from the points' mean distance and the grid's larger spacing [m].
[[nodiscard]] inline double resamplingWidth(double pointSpacing, double nodeSpacing) noexcept
{
    return std::max(pointSpacing, nodeSpacing / 2);
}

/// Returns the same for points that are means of many, each over a square whose side is their distance. Such a mean
/// smooths as well, with a variance of a twelfth of the square's side squared along either axis; so the Gaussian is
/// narrower, and both together smooth as it does alone where all points are taken. Means lie evenly, so that less than
/// half of their distance leaves no gap.
[[nodiscard]] inline double resamplingWidthOfMeans(double pointSpacing, double nodeSpacing) noexcept
{
    constexpr double kLeast   = 0.45; // [spacings of the points]
    const double     variance = nodeSpacing * nodeSpacing / 4 - pointSpacing * pointSpacing / 12; // [m^2]
    return std::max(kLeast * pointSpacing, std::sqrt(std::max(variance, 0.0)));
}

} // namespace palp
