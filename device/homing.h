#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "device/haptic_device.h"

namespace palp {

/// Waits in real time, at zero force, until the user has homed the device; returns at once if it needs no homing.
/// \param stop    ends the wait once it is true
/// \param tell    called with what the user must do, once homing takes longer than a second
/// \param isDone  called with each state, returns whether to end; empty: ends as soon as the device is homed
/// \return whether `tell` was called
/// \throws Error if the device is lost, or `stop` came first
bool waitForHoming(HapticDevice& device, const std::atomic<bool>& stop,
                   const std::function<void(const std::string&)>& tell,
                   const std::function<bool(const HapticState&)>& isDone = {});

} // namespace palp
