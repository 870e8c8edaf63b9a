#pragma once
#include <algorithm>

namespace palp {

/// Times by which a driver's thread holds the last force of a servo that no longer calls, lets it fall, and reports
/// the stall. Otherwise a servo that hangs in contact would push until the device's own watchdog acts, or for ever.
inline constexpr double kForceHold   = 5e-3;  ///< [s] held unchanged, so that slightly late ticks are not felt
inline constexpr double kForceFall   = 20e-3; ///< [s] of the fall to zero that follows, and of the return
inline constexpr double kHostTooSlow = 0.1;   ///< [s] from which on the fault is DeviceFault::hostTooSlow

/// Returns the share of the last force that may still act [1].
/// \param age  [s] since it was requested
[[nodiscard]] inline double heldShare(double age) noexcept
{
    return 1 - std::clamp((age - kForceHold) / kForceFall, 0.0, 1.0);
}

} // namespace palp
