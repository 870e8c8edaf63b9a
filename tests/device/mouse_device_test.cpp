#include "device/mouse_device.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/device/governed.h"

namespace palp {
namespace {

HapticState after(MouseDevice& mouse, double seconds, int ticks)
{
    HapticState state = mouse.exchange({}, 0);
    for (int n = 1; n <= ticks; ++n) state = mouse.exchange({}, seconds * n / ticks);
    return state;
}

TEST(MouseDevice, FollowsItsTargetAsTheSpringSays)
{
    // From rest at 0 to a target at 1 cm: x = 0.01 (1 - (1 + t/s) exp(-t/s)), v = 0.01 t/s² exp(-t/s).
    for (int ticks : {1, 7, 1000}) {
        MouseDevice mouse({.settle = 0.02});
        mouse.open();
        mouse.target({0.01, 0, 0});
        const HapticState state = after(mouse, 0.05, ticks);
        EXPECT_NEAR(state.position.x, 0.01 * (1 - 3.5 * std::exp(-2.5)), 1e-15) << ticks << " ticks, rounding";
        EXPECT_NEAR(state.velocity.x, 0.01 * 2.5 / 0.02 * std::exp(-2.5), 1e-13) << ticks << " ticks, rounding";
    }
}

TEST(MouseDevice, SpringsBackWhenItIsLetGo)
{
    MouseDevice mouse({.settle = 0.02, .rest = {0, 0, 0.03}});
    mouse.open();
    EXPECT_EQ(mouse.exchange({}, 0).position, glm::dvec3(0, 0, 0.03));
    mouse.target({0.01, 0, 0}, 1);
    for (int n = 1; n <= 1000; ++n) mouse.exchange({}, n * 1e-3);
    const HapticState there = mouse.exchange({}, 1.001);
    EXPECT_NEAR(glm::distance(there.position, {0.01, 0, 0}), 0, 1e-12) << "exp(-50) of the way";
    EXPECT_EQ(there.buttons, 1U);
    mouse.release();
    const HapticState back = mouse.exchange({}, 2.001);
    EXPECT_NEAR(glm::distance(back.position, {0, 0, 0.03}), 0, 1e-12) << "exp(-50) of the way";
    EXPECT_EQ(back.buttons, 0U);
}

TEST(MouseDevice, StaysWithinItsReach)
{
    MouseDevice mouse({.reach = 0.05});
    mouse.open();
    mouse.target({3, 4, 0});
    mouse.exchange({}, 0);
    EXPECT_LT(glm::length(mouse.exchange({}, 0.01).position), 0.005)
        << "pulled from the edge, not from 5 m away: (1 - 1.5 exp(-0.5)) 0.05 m";
    for (int n = 10; n < 500; ++n) EXPECT_LE(glm::length(mouse.exchange({}, n * 1e-3).position), 0.05 + 1e-15);
    EXPECT_NEAR(glm::distance(mouse.exchange({}, 0.6).position, {0.03, 0.04, 0}), 0, 1e-11) << "exp(-30), and rounding";
}

TEST(MouseDevice, ForcesMoveNothing)
{
    MouseDevice mouse;
    mouse.open();
    mouse.exchange({}, 0);
    const HapticState pushed = mouse.exchange(governed({1, -2, 0.5}), 1e-3);
    EXPECT_EQ(pushed.position, glm::dvec3(0));
    EXPECT_EQ(mouse.exchange(notFinite(), 2e-3).fault, DeviceFault::badForce);
    EXPECT_EQ(mouse.exchange({}, 3e-3).fault, DeviceFault::none);
}

TEST(MouseDevice, NonsenseDoesNotMoveIt)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    MouseDevice  mouse;
    EXPECT_EQ(mouse.exchange({}, 0).fault, DeviceFault::closed);
    mouse.open();
    mouse.target({0.01, 0, 0});
    mouse.target({nan, 0, 0});
    const HapticState before = after(mouse, 1, 10);
    EXPECT_NEAR(before.position.x, 0.01, 1e-12) << "the one before counts; exp(-50)";
    mouse.target({0, 0, 0});
    for (double odd : {nan, -nan, 0.5}) EXPECT_EQ(mouse.exchange({}, odd).position, before.position);
    EXPECT_THROW(MouseDevice({.settle = 0}), Error);
    EXPECT_THROW(MouseDevice({.rest = {1, 0, 0}}), Error);
    EXPECT_THROW(MouseDevice({.rest = {nan, 0, 0}}), Error);
}

TEST(MouseDevice, AnotherSessionsClockMovesItFromWhereItIs)
{
    MouseDevice mouse;
    mouse.open();
    mouse.target({0.01, 0, 0});
    const glm::dvec3 before = after(mouse, 1, 1000).position;
    mouse.target({0.02, 0, 0});
    EXPECT_EQ(mouse.exchange({}, 0).position, before) << "an hour earlier: no jump";
    HapticState state;
    for (int n = 1; n <= 200; ++n) state = mouse.exchange({}, n * 1e-3);
    EXPECT_NEAR(state.position.x, 0.02, 1e-5) << "and it goes on: exp(-10) of the way is left";
}

TEST(MouseDevice, TheWindowsThreadDisturbsNoTick)
{
    MouseDevice mouse;
    mouse.open();
    std::atomic<bool>   done{false};
    std::thread         window([&] {
        for (int n = 0; !done; ++n) {
            // Always two equal parts: a target that is torn would show.
            mouse.target(glm::dvec3(0.01 * std::sin(n), 0.01 * std::sin(n), 0));
        }
    });
    const GovernedForce push = governed({1, 1, 0});
    for (int n = 0; n < 100000; ++n) {
        const HapticState state = mouse.exchange(n % 2 ? push : GovernedForce{}, n * 1e-3);
        ASSERT_EQ(state.position.x, state.position.y);
    }
    done = true;
    window.join();
}

} // namespace
} // namespace palp
