#include "engine/session/held_falcon.h"

#include <algorithm>

namespace palp {
namespace {

/// The emulator has the encoders, the delays and the stops.
SimulatedArmSettings bareArm()
{
    SimulatedArmSettings arm;
    arm.encoderStep  = 0;
    arm.delaySamples = 0;
    return arm;
}

FalconDeviceSettings stepped(FalconDeviceSettings settings)
{
    settings.pace = FalconPace::stepped;
    return settings;
}

} // namespace

Ft232EmulatorSettings HeldFalcon::ready()
{
    Ft232EmulatorSettings settings;
    settings.falcon.running = settings.falcon.homed = true;
    return settings;
}

HeldFalcon::HeldFalcon(const HoldingHand& hand, const Ft232EmulatorSettings& falcon, const FalconDeviceSettings& device)
    : hand_(hand), arm_(bareArm(), hand.at(0).target),
      emulator_(falcon, [this](const glm::dvec3& force, double dt) { return moved(force, dt); }),
      device_([this] { return emulator_.connect(); }, stepped(device)), info_(device_.info())
{
    hand.demandWithin(info_.workspaceRadius);
    info_.model        = "emulated Falcon";
    info_.isSimulation = true;
}

void HeldFalcon::follow() noexcept
{
    led_.reset();
    running_ = false;
}

HapticState HeldFalcon::exchange(const GovernedForce& force, double now) noexcept
{
    if (!running_) begun_ = emulator_.now() - now;
    running_ = true;
    if (const std::uint32_t wanted = hand_.path.buttons(hand_.path.begin() + now); wanted != pressed_) {
        emulator_.falcon().press(std::uint8_t(wanted));
        pressed_ = wanted;
    }
    return device_.exchange(force, now);
}

glm::dvec3 HeldFalcon::moved(const glm::dvec3& force, double dt)
{
    SimulatedHand hand = hand_.at(running_ ? std::max(0.0, emulated_ - begun_) : 0);
    if (led_) {
        hand.target         = *led_;
        hand.targetVelocity = {};
    }
    arm_.hold(hand);
    emulated_ += dt;
    arm_.step(force, dt);
    return arm_.position();
}

} // namespace palp
