#pragma once
#include <algorithm>

namespace palp {

/// Noise beyond which a touch averages over more than its usual some spacings [spacings]. At 0.12 the proxy's own fit
/// leaves 0.025 of a spacing, about what the touch scale leaves; clean scans have 0.03, with less than a hundredth of
/// their points above this.
inline constexpr double kNoisySpacings = 0.12;

/// Distance of the averaged points over the standard deviation of the noise [1]: 11 leaves ripples of up to 1 % where a
/// hand is two spacings deep, 8 leaves 1.3 %. With more noise 7 do, as only a smaller share of it would go for what
/// more blurs: ripples of up to 1.6 %.
inline constexpr double kTouchScaleOfNoise = 11, kTouchScaleOfMuchNoise = 7;

/// Distance up to which the former holds [spacings]: noise of a third to a half of a spacing.
inline constexpr double kUsualTouchScale = 3.5;

/// Largest touch scale [spacings]: beyond it is no surface that a survey could see.
inline constexpr double kLargestTouchScale = 16;

/// Returns the distance of the points over which a touch averages [m]; the spacing where there is hardly any noise.
/// \param noise, spacing  [m]
[[nodiscard]] inline double touchScale(double noise, double spacing)
{
    const double usual = std::min(kTouchScaleOfNoise * noise, kUsualTouchScale * spacing);
    return std::clamp(std::max(usual, kTouchScaleOfMuchNoise * noise), spacing, kLargestTouchScale * spacing);
}

} // namespace palp
