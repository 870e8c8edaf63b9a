#include "device/arm_device.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kHostStall = 0.1; // [s] see DeviceFault::hostTooSlow
constexpr double kLongest   = 1;   // [s] the arm moves on by at most this in one exchange: 8000 pieces, some 0.5 ms

} // namespace

ArmDevice::ArmDevice(const SimulatedArmSettings& settings, const glm::dvec3& start)
    : settings_(settings), start_(start), arm_(settings, start)
{
    info_.model            = "simulated arm";
    info_.workspaceRadius  = settings.boxRadius;
    info_.maximumForce     = 8;    // N: CHAI3D's value for the Falcon, which the arm is modelled on
    info_.maximumStiffness = 1000; // N/m: half of the 2137 N/m up to which the released arm is stable at 1 kHz
    info_.mass             = settings.mass;
    info_.ownDamping       = settings.damping;
    info_.weight           = settings.weight;
    info_.isSimulation     = true;
}

void ArmDevice::open()
{
    if (state_.fault != DeviceFault::closed) return;
    arm_ = SimulatedArm(settings_, start_);
    arm_.holdBy(hand_);
    ticked_      = false;
    wanted_      = {};
    state_       = {};
    state_.homed = true;
    state_.fault = DeviceFault::none;
}

void ArmDevice::close() noexcept
{
    state_.velocity = {};
    state_.fault    = DeviceFault::closed;
}

HapticState ArmDevice::read(double now) noexcept
{
    if (state_.fault == DeviceFault::closed) return state_;
    const bool   good   = std::isfinite(wanted_.x + wanted_.y + wanted_.z);
    const double passed = ticked_ ? now - last_ : 0;
    if (!std::isfinite(now) || passed < 0) { // the clock is unusable: nothing moves, and no answer is new
        ++state_.missed;
        return state_;
    }
    const bool late = passed > kHostStall;
    state_.fault    = !good ? DeviceFault::badForce : late ? DeviceFault::hostTooSlow : DeviceFault::none;
    // With a delay of one tick a step holds the force of the step before.
    if (late) arm_.step({}, kHostStall);
    const double   left     = std::min(passed, kLongest) - (late ? kHostStall : 0);
    const ArmState armState = arm_.step(state_.fault == DeviceFault::none ? wanted_ : glm::dvec3(0), left);
    ticked_                 = true;
    last_                   = now;
    state_.time             = now;
    state_.position         = armState.position;
    state_.velocity         = armState.velocity;
    state_.age              = std::max(0, settings_.delayTicks - 1) * left; // the delay beyond a tick
    state_.inBox            = armState.inBox;
    state_.missed           = 0;
    ++state_.sequence;
    return state_;
}

void ArmDevice::holdBy(const SimulatedHand& hand) noexcept
{
    hand_ = hand;
    arm_.holdBy(hand);
}

} // namespace palp
