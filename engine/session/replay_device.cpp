#include "engine/session/replay_device.h"

#include <limits>

#include "engine/session/servo.h"

namespace palp {

ReplayDevice::ReplayDevice(const std::vector<TickRecord>& records, const HapticDeviceInfo& limits)
    : records_(records), info_(limits)
{
    info_.model           = "recorded hand";
    info_.workspaceRadius = std::numeric_limits<double>::infinity();
    info_.isSimulation    = true;
}

HapticState ReplayDevice::read(double now) noexcept
{
    HapticState state;
    state.time = now;
    if (next_ == records_.size()) {
        state.fault = DeviceFault::unplugged;
        return state;
    }
    const TickRecord& record = records_[next_];
    Hand              hand;
    hand.setBits(record.device);
    ++next_;
    // As old as it was then, and on the clock of then to the bit.
    state.time         = now == record.time ? record.answerTime : now - (record.time - record.answerTime);
    state.age          = record.answerAge;
    state.sequence     = record.answers;
    state.orientation  = record.orientation;
    state.gripperAngle = record.grip;
    state.position     = record.hip;
    state.velocity     = record.hipVelocity;
    state.buttons      = hand.buttons;
    state.clutched     = hand.clutched;
    state.homed        = hand.homed;
    state.inBox        = hand.inBox;
    state.missed       = record.missed;
    state.fault        = hand.device;
    return state;
}

} // namespace palp
