#pragma once
#include <functional>

#include "device/haptic_device.h"

namespace palp {

/// How fast an open device answers, at zero force.
struct ExchangeRate {
    double perSecond = 0; ///< [1/s] answers; 0: there were none
    double age       = 0; ///< [s] mean age of a position when its answer came; 0 also if the driver does not know it
    double longest   = 0; ///< [s] between two answers that the servo saw
};

/// Exchanges zero force with an open device for a while. The first 50 ms do not count.
/// \param seconds  [s] for how long
/// \param wait     waits for the servo's next tick and returns its time [s]
[[nodiscard]] ExchangeRate measureExchanges(HapticDevice& device, double seconds, const std::function<double()>& wait);

} // namespace palp
