#include "device/scripted_device.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/device/governed.h"

namespace palp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(ScriptedDevice, GoesAlongItsPathWhateverTheForce)
{
    ScriptedDevice hand([](double now) { return glm::dvec3(0.1 * now, now * now, 0); }, 0.5);
    EXPECT_EQ(hand.exchange({}, 0).fault, DeviceFault::closed);
    hand.open();
    EXPECT_EQ(hand.exchange({}, 0.5).velocity, glm::dvec3(0)) << "nothing to difference yet";
    const HapticState state = hand.exchange(governed({1, 2, 3}), 0.6);
    EXPECT_EQ(state.position, glm::dvec3(0.1 * 0.6, 0.6 * 0.6, 0));
    EXPECT_NEAR(state.velocity.x, 0.1, 1e-14) << "rounding of the difference";
    EXPECT_NEAR(state.velocity.y, 1.1, 1e-14) << "rounding of the difference";
    EXPECT_TRUE(state.homed && state.inBox);
    EXPECT_FALSE(hand.exchange({}, 0.8).inBox) << "0.65 m away";
    EXPECT_EQ(hand.exchange(notFinite(), 0.9).fault, DeviceFault::badForce);
}

TEST(ScriptedDevice, APathThatFailsIsAFaultAndTheHandStays)
{
    ScriptedDevice hand([](double now) -> glm::dvec3 {
        if (now > 2) throw std::runtime_error("the script's mistake");
        return {now > 1 ? kNan : 0.1, 0, 0};
    });
    hand.open();
    hand.exchange({}, 0.5);
    for (double now : {1.5, 2.5}) {
        const HapticState state = hand.exchange({}, now);
        EXPECT_EQ(state.fault, DeviceFault::kinematics);
        EXPECT_EQ(state.position, glm::dvec3(0.1, 0, 0));
        EXPECT_EQ(state.sequence, 1U);
    }
    EXPECT_EQ(hand.exchange({}, 0.9).fault, DeviceFault::none);
    EXPECT_THROW(ScriptedDevice(HandPath{}), Error);
    EXPECT_THROW(ScriptedDevice([](double) { return glm::dvec3(0); }, 0), Error);
}

TEST(Replayed, GoesStraightFromPointToPoint)
{
    const HandPath path = replayed({{10, {0, 0, 0}}, {11, {1, 0, 0}}, {13, {1, 4, 0}}}, 100);
    EXPECT_EQ(path(0), glm::dvec3(0)) << "at rest before";
    EXPECT_EQ(path(100), glm::dvec3(0));
    EXPECT_EQ(path(100.25), glm::dvec3(0.25, 0, 0));
    EXPECT_EQ(path(101), glm::dvec3(1, 0, 0));
    EXPECT_EQ(path(102), glm::dvec3(1, 2, 0));
    EXPECT_EQ(path(103), glm::dvec3(1, 4, 0));
    EXPECT_EQ(path(1e9), glm::dvec3(1, 4, 0)) << "and after";
    EXPECT_EQ(replayed({{5, {7, 8, 9}}})(0), glm::dvec3(7, 8, 9));
}

TEST(Replayed, RefusesWhatIsNoPath)
{
    EXPECT_THROW(static_cast<void>(replayed({})), Error);
    EXPECT_THROW(static_cast<void>(replayed({{0, {}}, {0, {}}})), Error);
    EXPECT_THROW(static_cast<void>(replayed({{kNan, {}}})), Error);
    EXPECT_THROW(static_cast<void>(replayed({{0, {kNan, 0, 0}}})), Error);
}

} // namespace
} // namespace palp
