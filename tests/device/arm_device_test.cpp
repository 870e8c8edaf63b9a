#include "device/arm_device.h"

#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/device/governed.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3; // [s]

TEST(ArmDevice, IsTheSimulatedArmTickForTick)
{
    const SimulatedHand hand{.stiffness = 150, .damping = 1, .target = {0.01, 0, 0}, .targetVelocity = {0, 0.02, 0}};
    const GovernedForce push = governed({1, -2, 0.5});
    SimulatedArm        arm;
    arm.holdBy(hand);
    ArmDevice device;
    device.holdBy(hand);
    device.open();
    device.exchange({}, 0);

    double now = 0;
    for (int n = 0; n < 500; ++n) {
        const double last = now;
        now += kTick;
        const HapticState state    = device.exchange(push, now);
        const ArmState    armState = arm.step({1, -2, 0.5}, now - last);
        ASSERT_EQ(state.position, armState.position) << "the same bits, tick " << n;
        ASSERT_EQ(state.velocity, armState.velocity);
        ASSERT_EQ(state.inBox, armState.inBox);
        ASSERT_EQ(state.time, now);
    }
    EXPECT_GT(glm::length(device.arm().position()), 1e-3) << "it moved";
}

TEST(ArmDevice, AForceActsFromItsExchangeOn)
{
    ArmDevice device({.encoderStep = 0, .delayTicks = 1});
    device.open();
    device.exchange({}, 0);
    EXPECT_EQ(device.exchange(governed({1, 0, 0}), kTick).position, glm::dvec3(0)) << "none acted until now";
    EXPECT_GT(device.exchange({}, 2 * kTick).position.x, 0) << "that one did";
}

TEST(ArmDevice, AHostThatStaysAwayMeansNoForceAfterATenthOfASecond)
{
    const SimulatedArmSettings smooth{.encoderStep = 0, .halfWorkspace = 10};
    const GovernedForce        push = governed({1, 0, 0});
    ArmDevice                  device(smooth);
    device.open();
    device.exchange({}, 0);
    device.exchange(push, kTick);
    const HapticState late = device.exchange(push, kTick + 0.4);

    SimulatedArm arm(smooth);
    arm.step({1, 0, 0}, kTick);
    arm.step({}, 0.1);
    arm.step({}, 0.3);
    EXPECT_EQ(late.fault, DeviceFault::hostTooSlow);
    EXPECT_NEAR(late.position.x, arm.position().x, 1e-12) << "rounding of the times";
    const HapticState next = device.exchange(push, kTick + 0.401);
    EXPECT_EQ(next.fault, DeviceFault::none);
    EXPECT_NEAR(next.position.x, arm.step({}, 1e-3).position.x, 1e-12) << "the late force was not rendered; rounding";

    const double there = device.exchange({}, kTick + 0.402).position.x;
    EXPECT_LT(device.exchange({}, 1e9).position.x - there, 1) << "years are left out";
}

TEST(ArmDevice, BadForcesAndClocksDoNotMoveIt)
{
    ArmDevice device({.encoderStep = 0});
    device.open();
    device.exchange({}, 1);
    EXPECT_EQ(device.exchange(notFinite(), 1 + kTick).fault, DeviceFault::badForce);
    EXPECT_EQ(device.exchange({}, 1 + 2 * kTick).position, glm::dvec3(0)) << "nothing was rendered";
    const HapticState before = device.exchange(governed({1, 0, 0}), 1 + 3 * kTick);
    for (double odd : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 0.5}) {
        const HapticState state = device.exchange({}, odd);
        EXPECT_EQ(state.position, before.position);
        EXPECT_EQ(state.sequence, before.sequence) << "nothing new, clock " << odd;
        EXPECT_GT(state.missed, 0);
    }
    EXPECT_GT(device.exchange({}, 1 + 4 * kTick).position.x, 0) << "and then it goes on";
}

TEST(ArmDevice, OpensAtItsStart)
{
    ArmDevice device({}, {0.0096, 0, 0});
    EXPECT_EQ(device.exchange({}, 0).fault, DeviceFault::closed);
    device.open();
    device.exchange({}, 0);
    for (int n = 1; n < 100; ++n) device.exchange(governed({1, 0, 0}), n * kTick);
    device.close();
    EXPECT_EQ(device.exchange({}, 1).fault, DeviceFault::closed);
    device.open();
    EXPECT_NEAR(device.exchange({}, 7).position.x, 0.0096, 1e-12) << "200 encoder steps of 48 um; rounding";
}

TEST(ArmDevice, SaysWhatItsArmIsAndHowOldItsPositionsAre)
{
    for (const auto& [delay, age] : {std::pair{0, 0.0}, {1, 0.0}, {3, 2e-3}}) { // the tick's own delay is the servo's
        ArmDevice device({.mass = 0.2, .damping = 0.7, .delayTicks = delay});
        EXPECT_EQ(device.info().mass, 0.2);
        EXPECT_EQ(device.info().ownDamping, 0.7);
        device.open();
        device.read(0);
        EXPECT_NEAR(device.read(kTick).age, age, 1e-12);
    }
}

TEST(ArmDevice, WithoutADelayAForceActsFromItsTickOn)
{
    ArmDevice device({.encoderStep = 0, .delayTicks = 0});
    device.open();
    device.read(0);
    device.render(governed({1, 0, 0}));
    EXPECT_NEAR(device.read(kTick).position.x, 0.5 / 0.46 * kTick * kTick, 1e-8) << "damping takes 0.3 %";
}

} // namespace
} // namespace palp
