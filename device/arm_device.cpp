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
    if (settings.delayTicks < 1)
        throw Error("arm: delayTicks must be from 1 to 7, found " + std::to_string(settings.delayTicks));
    info_.model            = "simulated arm";
    info_.workspaceRadius  = settings.boxRadius;
    info_.maximumForce     = 8;    // N: CHAI3D's value for the Falcon, which the arm is modelled on
    info_.maximumStiffness = 1000; // N/m: half of the 2137 N/m up to which the released arm is stable at 1 kHz
    info_.isSimulation     = true;
}

void ArmDevice::open()
{
    if (state_.fault != DeviceFault::closed) return;
    arm_ = SimulatedArm(settings_, start_);
    arm_.holdBy(hand_);
    ticked_      = false;
    state_       = {};
    state_.homed = true;
    state_.fault = DeviceFault::none;
}

void ArmDevice::close() noexcept
{
    state_.velocity = {};
    state_.fault    = DeviceFault::closed;
}

HapticState ArmDevice::exchange(const GovernedForce& force, double now) noexcept
{
    if (state_.fault == DeviceFault::closed) return state_;
    const glm::dvec3 wanted = force.newtons();
    const bool       good   = std::isfinite(wanted.x + wanted.y + wanted.z);
    const double     passed = ticked_ ? now - last_ : 0;
    if (!std::isfinite(now) || passed < 0) { // the clock is unusable: nothing moves, and no answer is new
        ++state_.missed;
        return state_;
    }
    const bool late = passed > kHostStall;
    state_.fault    = !good ? DeviceFault::badForce : late ? DeviceFault::hostTooSlow : DeviceFault::none;
    // A step holds the force of the step before: the force of the last exchange has acted until now.
    if (late) arm_.step({}, kHostStall);
    const double   left     = std::min(passed, kLongest) - (late ? kHostStall : 0);
    const ArmState armState = arm_.step(state_.fault == DeviceFault::none ? wanted : glm::dvec3(0), left);
    ticked_                 = true;
    last_                   = now;
    state_.time             = now;
    state_.position         = armState.position;
    state_.velocity         = armState.velocity;
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
