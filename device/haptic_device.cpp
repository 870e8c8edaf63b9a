#include "device/haptic_device.h"

namespace palp {

const char* name(DeviceFault fault) noexcept
{
    switch (fault) {
    case DeviceFault::none:
        return "none";
    case DeviceFault::closed:
        return "closed";
    case DeviceFault::unplugged:
        return "unplugged";
    case DeviceFault::silent:
        return "silent";
    case DeviceFault::garbled:
        return "garbled";
    case DeviceFault::kinematics:
        return "kinematics";
    case DeviceFault::ownWatchdog:
        return "own-watchdog";
    case DeviceFault::badForce:
        return "bad-force";
    case DeviceFault::startingUp:
        return "starting-up";
    case DeviceFault::hostTooSlow:
        return "host-too-slow";
    }
    return "unknown";
}

} // namespace palp
