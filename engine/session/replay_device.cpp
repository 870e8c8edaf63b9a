#include "engine/session/replay_device.h"

#include <limits>

#include "engine/session/servo.h"

namespace palp {

ReplayDevice::ReplayDevice(const std::vector<TickRecord>& samples, const HapticDeviceInfo& limits)
    : samples_(samples), info_(limits)
{
    info_.model           = "recorded hand";
    info_.workspaceRadius = std::numeric_limits<double>::infinity();
    info_.isSimulation    = true;
}

HapticState ReplayDevice::exchange(const GovernedForce& /*force*/, double now) noexcept
{
    HapticState state;
    state.time = now;
    if (next_ == samples_.size()) {
        state.fault = DeviceFault::unplugged;
        return state;
    }
    const TickRecord& sample = samples_[next_];
    Hand              hand;
    hand.setBits(sample.device);
    state.sequence = ++next_;
    state.position = sample.hip;
    state.velocity = sample.hipVelocity;
    state.buttons  = hand.buttons;
    state.homed    = hand.homed;
    state.inBox    = hand.inBox;
    state.missed   = sample.missed;
    state.fault    = hand.device;
    return state;
}

} // namespace palp
