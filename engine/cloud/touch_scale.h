#pragma once

namespace palp {

/// Noise beyond which a touch averages over more than its usual some spacings [spacings]. At 0.2 the proxy's fit leaves
/// 0.04 of a spacing, which is bearable.
inline constexpr double kNoisySpacings = 0.25;

/// Distance of the averaged points over the standard deviation of the noise [1]: 6 leaves ripples of up to 2.4 %, 7
/// less than 2 %.
inline constexpr double kTouchScaleOfNoise = 7;

} // namespace palp
