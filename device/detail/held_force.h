#pragma once
#include <algorithm>

namespace palp {

/// What a driver's thread does with the last force while its servo does not ask: it holds it, lets it fall, and in the
/// end says so. A servo that hangs in contact would else push on, up to the device's own watchdog or for ever.
inline constexpr double kForceHold   = 5e-3;  ///< [s] ticks that are a little late are not felt
inline constexpr double kForceFall   = 20e-3; ///< [s] then, to zero; and as long to come back
inline constexpr double kHostTooSlow = 0.1;   ///< [s] then DeviceFault::hostTooSlow

/// [1] of the last force that may still act.
/// \param age  [s] since it was asked for
[[nodiscard]] inline double heldShare(double age) noexcept
{
    return 1 - std::clamp((age - kForceHold) / kForceFall, 0.0, 1.0);
}

} // namespace palp
