#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "device/haptic_device.h"

namespace palp {

/// Waits in real time, at zero force, until somebody has homed the device. One that needs no homing is not waited for.
/// \param stop    gives up once it is true
/// \param tell    is told what the user must do, once homing takes longer than a second
/// \param isDone  sees each state and says whether to end; empty: as soon as the device is homed
/// \return whether it had told
/// \throws Error if the device is lost, or `stop` came first
bool waitForHoming(HapticDevice& device, const std::atomic<bool>& stop,
                   const std::function<void(const std::string&)>& tell,
                   const std::function<bool(const HapticState&)>& isDone = {});

} // namespace palp
