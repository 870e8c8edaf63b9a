#include "engine/session/gripped_arm.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp {

const DeviceRecord kArmRecord{.name      = "arm",
                              .model     = "a simulated arm like the Falcon's",
                              .holder    = DeviceHolder::scriptedHand,
                              .simulated = true,
                              .make      = [](const DeviceRequest& request) -> std::unique_ptr<HapticDevice> {
                                  return std::make_unique<GrippedArm>(*request.hand);
                              }};

SimulatedHand GrippingHand::at(double time, const glm::dvec3& weight) const noexcept
{
    constexpr double kStep  = 1e-3; // [s] over which the target's velocity is taken
    constexpr double kCarry = 1.5;  // [s] in which the governor takes the weight over
    const double     there  = path.begin() + time;
    SimulatedHand    hand   = grip;
    hand.target             = frame.toDevice(path.position(there));
    hand.targetVelocity     = (frame.toDevice(path.position(there + kStep)) - hand.target) / kStep;
    if (grip.stiffness > 0) hand.target -= std::clamp(1 - time / kCarry, 0.0, 1.0) * weight / grip.stiffness;
    return hand;
}

glm::dquat GrippingHand::orientation(double time) const noexcept
{
    return glm::conjugate(frame.sceneFromDevice) * path.orientation(path.begin() + time);
}

void GrippingHand::demandWithin(double radius) const
{
    for (const HandPose& s : path.waypoints())
        if (const double away = glm::length(frame.toDevice(s.position)); away > radius)
            throw Error("the hand: at " + formatQuantity(s.time, "s") + " it is " + formatQuantity(away, "m") +
                        " from the middle of the arm's workspace, whose radius is " + formatQuantity(radius, "m") +
                        "; try a smaller --reach, a larger --workspace-scale, or a scene whose start_height is lower");
}

GrippedArm::GrippedArm(const GrippingHand& hand, const SimulatedArmSettings& arm)
    : hand_(hand), weight_(arm.weight), arm_(arm, hand.at(0).target)
{
    hand.demandWithin(arm.boxRadius);
}

HapticState GrippedArm::read(double now) noexcept
{
    HapticState state = arm_.read(now); // moves on to now, with the hand of the last tick
    state.buttons     = hand_.path.buttons(hand_.path.begin() + now);
    arm_.holdBy(hand_.at(now, weight_));
    return state;
}

} // namespace palp
