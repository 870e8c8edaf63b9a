#include "engine/session/held_arm.h"

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp {

HeldArm::HeldArm(const HandPath& path, const SimulatedHand& grip, const glm::dvec3& origin,
                 const SimulatedArmSettings& arm)
    : path_(path), grip_(grip), origin_(origin), arm_(arm, path.position(path.begin()) - origin)
{
    for (const HandSample& s : path.samples())
        if (const double away = glm::length(s.position - origin); away > arm.boxRadius)
            throw Error("arm: at " + formatQuantity(s.time, "s") + " the hand is " + formatQuantity(away, "m") +
                        " from the middle of the arm's workspace, whose radius is " +
                        formatQuantity(arm.boxRadius, "m") + "; try a smaller --reach or a scene with a lower start");
}

HapticState HeldArm::exchange(const GovernedForce& force, double now) noexcept
{
    constexpr double  kStep = 1e-3;                      // [s] over which the target's velocity is taken
    const HapticState state = arm_.exchange(force, now); // on to now, by the hand of the last tick
    const double      time  = path_.begin() + now;
    SimulatedHand     hand  = grip_;
    hand.target             = path_.position(time) - origin_;
    hand.targetVelocity     = (path_.position(time + kStep) - path_.position(time)) / kStep;
    arm_.hold(hand);
    return state;
}

} // namespace palp
