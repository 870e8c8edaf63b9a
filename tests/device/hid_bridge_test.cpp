#include "device/hid/hid_bridge.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/device/fake_bridge.h"
#include "tests/device/fake_hid.h"
#include "tests/device/governed.h"

namespace palp {
namespace {

using Report = FakeHidDevice::Report;

constexpr double kTick = 1e-3;  // [s]
constexpr double kStep = 1e-12; // rounding of whole steps of 1e-6 m or 1e-3 N

class Bridge : public testing::Test {
protected:
    static HidBridgeSettings settings() { return {.openWait = 0.05, .pace = HidPace::caller}; }

    Bridge() { firmware.tick(kTick); } // the report that open() waits for

    /// Both sides go on together.
    HapticState after(int ticks, const GovernedForce& force = {})
    {
        HapticState state;
        for (int n = 0; n < ticks; ++n) {
            firmware.tick(kTick);
            state = bridge.exchange(force, now += kTick);
        }
        return state;
    }
    /// The device says nothing.
    HapticState alone(int ticks, const GovernedForce& force = {})
    {
        HapticState state;
        for (int n = 0; n < ticks; ++n) state = bridge.exchange(force, now += kTick);
        return state;
    }

    FakeHidSystem   system;
    FakeHidDevice&  device = system.plug(ours());
    FakeBridge      firmware{device};
    HidBridgeDevice bridge{system, ours(), settings()};
    GovernedForce   push = governed({1, -2, 0.5});
    double          now  = 100; // [s]
};

TEST_F(Bridge, SaysWhatItIs)
{
    EXPECT_EQ(bridge.info().model, "Workshop arm");
    EXPECT_EQ(bridge.exchange(push, now).fault, DeviceFault::closed);
    bridge.open();
    EXPECT_NEAR(bridge.info().workspaceRadius, 0.05, kStep);
    EXPECT_NEAR(bridge.info().maximumForce, 4, kStep);
    EXPECT_EQ(bridge.info().mass, 0) << "unknown, since the report has no field for it";
    EXPECT_EQ(bridge.info().buttons, 2U);
    EXPECT_FALSE(bridge.info().isSimulation);
    EXPECT_FALSE(firmware.commands().at(0).enable) << "the first command says zero";
}

TEST_F(Bridge, ItsOwnDampingIsKnownIfItSaysSo)
{
    bridge.open();
    EXPECT_EQ(bridge.info().ownDamping, 0) << "unknown";
    bridge.close();
    firmware.answer.ownDamping = 0.4;
    firmware.tick(kTick);
    bridge.open();
    EXPECT_NEAR(bridge.info().ownDamping, 0.4, kStep);
}

TEST_F(Bridge, ItsPositionsAreAsOldAsUsbMakesThem)
{
    bridge.open();
    EXPECT_EQ(after(3).age, 1e-3);
}

TEST_F(Bridge, CommandsThatWaitOnTheirWayAddToItsLagAndEndTheForceInTheEnd)
{
    bridge.open();
    EXPECT_EQ(after(100, push).fault, DeviceFault::none);
    firmware.late = 8;
    // The bridge takes its times from the clock, and here all commands leave at once: they are sent a millisecond
    // apart.
    const auto slowly = [&](int ticks) {
        HapticState state;
        for (int n = 0; n < ticks; ++n) {
            state = after(1, push);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return state;
    };
    HapticState state = slowly(60);
    for (int n = 0; n < 5 && state.fault != DeviceFault::none; ++n)
        state = slowly(60); // a machine that is busy is slower
    EXPECT_EQ(state.fault, DeviceFault::none);
    EXPECT_GE(state.age, 4e-3) << "8 commands of a millisecond and more each, less what is usual";
    firmware.late = 40;
    EXPECT_EQ(slowly(60).fault, DeviceFault::ownWatchdog);
    EXPECT_FALSE(firmware.commands().back().enable);
    firmware.late = 0;
    EXPECT_EQ(slowly(10).fault, DeviceFault::none);
}

TEST_F(Bridge, ADeviceThatFollowsAnotherProgramGetsNoForce)
{
    bridge.open();
    EXPECT_EQ(after(100, push).fault, DeviceFault::none);
    firmware.foreign = true;
    EXPECT_EQ(after(1, push).fault, DeviceFault::ownWatchdog);
    EXPECT_FALSE(firmware.commands().back().enable);
    EXPECT_NE(std::string(bridge.faultWords()).find("another program"), std::string::npos);
    firmware.foreign = false;
    EXPECT_EQ(after(2, push).fault, DeviceFault::none);
    EXPECT_STREQ(bridge.faultWords(), "");
}

TEST_F(Bridge, NumbersThatWrapAroundAreOurs)
{
    bridge.open();
    for (int n = 0; n < 140'000; ++n) ASSERT_EQ(after(1, push).fault, DeviceFault::none) << n;
}

TEST_F(Bridge, ADeviceThatNeverTellsTheCommandIsNotJudged)
{
    firmware.foreign = true;
    bridge.open();
    EXPECT_EQ(after(500, push).fault, DeviceFault::none);
}

TEST_F(Bridge, ForceGoesOutAndPositionComesIn)
{
    bridge.open();
    firmware.answer.position = {0.01, -0.02, 0.03};
    firmware.answer.velocity = {0.1, 0, -0.2};
    firmware.answer.buttons  = 2;
    const HapticState state  = after(10, push);

    EXPECT_EQ(state.fault, DeviceFault::none);
    EXPECT_NEAR(glm::distance(state.position, {0.01, -0.02, 0.03}), 0, kStep);
    EXPECT_NEAR(glm::distance(state.velocity, {0.1, 0, -0.2}), 0, kStep);
    EXPECT_EQ(state.buttons, 2U);
    EXPECT_EQ(state.sequence, 11U) << "one at opening, ten since";
    EXPECT_EQ(state.time, now);
    EXPECT_EQ(state.missed, 0);
    EXPECT_TRUE(state.homed && state.inBox);
    EXPECT_NEAR(glm::distance(firmware.force(), {1, -2, 0.5}), 0, kStep);
}

TEST_F(Bridge, AStrongForceKeepsItsDirection)
{
    bridge.open();
    bridge.close();
    firmware.answer.maximumForce = 2;
    firmware.tick(kTick);
    bridge.open();
    EXPECT_NEAR(bridge.info().maximumForce, 2, kStep);
    after(3, governed({3, -4, 0}));
    EXPECT_NEAR(glm::distance(firmware.force(), {1.2, -1.6, 0}), 0, 1e-3) << "2 N along it; a step of the field";
}

TEST_F(Bridge, NoForceBeforeItIsHomed)
{
    firmware.answer.flags = std::uint16_t(BridgeFlag::inBox);
    bridge.open();
    bridge.home();
    EXPECT_FALSE(after(5, push).homed);
    EXPECT_EQ(firmware.force(), glm::dvec3(0));
    EXPECT_TRUE(firmware.commands().back().home);
    firmware.answer.flags = BridgeFlag::homed | BridgeFlag::inBox;
    EXPECT_TRUE(after(2, push).homed);
    EXPECT_GT(glm::length(firmware.force()), 1);
    EXPECT_FALSE(firmware.commands().back().home);
}

TEST_F(Bridge, CommandsAreNumberedAndCarryTheWatchdog)
{
    bridge.open();
    bridge.light(5);
    after(20, push);
    const std::vector<BridgeCommand> commands = firmware.commands();
    ASSERT_EQ(commands.size(), 21U);
    for (std::size_t n = 1; n < commands.size(); ++n) {
        EXPECT_EQ(commands[n].sequence, commands[n - 1].sequence + 1);
        EXPECT_NEAR(commands[n].watchdog, 0.025, kStep);
        EXPECT_EQ(commands[n].lights, 5);
    }
}

TEST_F(Bridge, ASilentDeviceIsAFaultAndGetsZero)
{
    bridge.open();
    after(10, push);
    EXPECT_EQ(alone(20, push).fault, DeviceFault::none) << "20 may be missed";
    EXPECT_EQ(alone(1, push).fault, DeviceFault::silent);
    EXPECT_EQ(alone(1, push).missed, 4) << "the governor's 20 are 100 ms";
    EXPECT_EQ(firmware.force(), glm::dvec3(0)) << "the commands still arrive";
    EXPECT_EQ(after(1, push).fault, DeviceFault::none) << "it is back";

    now += 0.1; // a slow servo: 100 ms without an answer are silence too, however few exchanges
    EXPECT_EQ(alone(1, push).fault, DeviceFault::silent);
}

TEST_F(Bridge, GarbageIsAFaultOfItsOwn)
{
    bridge.open();
    after(10, push);
    DeviceFault fault{};
    for (int n = 0; n < 21; ++n) {
        device.send(Report(64, std::uint8_t(n)));
        device.send(Report(70, 1)); // too long
        fault = alone(1, push).fault;
    }
    EXPECT_EQ(fault, DeviceFault::garbled);
    EXPECT_EQ(firmware.force(), glm::dvec3(0));
    EXPECT_EQ(after(1, push).fault, DeviceFault::none) << "one good answer is enough";
}

TEST_F(Bridge, OldAnswersAreNotNews)
{
    bridge.open();
    firmware.answer.position = {0.01, 0, 0};
    after(10);
    BridgeAnswer old = firmware.answer;
    old.position     = {-0.04, 0, 0};
    HapticState state;
    for (int n = 0; n < 100; ++n) { // a buffer that is stuck
        const BridgeBytes bytes = encode(old);
        device.send(Report(bytes.begin(), bytes.end()));
        state = alone(1);
        EXPECT_NEAR(state.position.x, 0.01, kStep);
    }
    EXPECT_EQ(state.fault, DeviceFault::silent);
    EXPECT_EQ(state.missed, 20) << "the governor's 20 are 100 ms";
}

TEST_F(Bridge, SequenceNumbersWrapAround)
{
    bridge.open();
    for (int sequence : {20000, 40000, 60000, 65530}) { // each less than half the range ahead, thus news
        firmware.answer.sequence = std::uint16_t(sequence);
        EXPECT_EQ(after(1).missed, 0) << sequence;
    }
    const HapticState state = after(20, push);
    EXPECT_EQ(state.missed, 0);
    EXPECT_EQ(state.sequence, 25U) << "each counts";
}

TEST_F(Bridge, ADeviceThatStartedAnewIsHeardAgain)
{
    firmware.answer.sequence = 20000;
    firmware.tick(kTick);
    bridge.open();
    after(10);
    firmware.answer.sequence = 0;
    EXPECT_EQ(after(15).missed, 3) << "it could be old reports; the governor's 20 are 100 ms";
    EXPECT_EQ(after(15).missed, 0);
}

TEST_F(Bridge, ItsOwnWatchdogIsToldAndLetGo)
{
    bridge.open();
    after(10, push);
    for (int n = 0; n < 30; ++n) firmware.tick(kTick); // 30 ms without a command, 25 allowed
    EXPECT_TRUE(firmware.stopped());
    EXPECT_EQ(firmware.force(), glm::dvec3(0));
    const HapticState told = alone(1, push); // within 100 ms, so it is not the host that is blamed
    EXPECT_EQ(told.fault, DeviceFault::ownWatchdog);
    EXPECT_FALSE(firmware.commands().back().enable) << "which lets it go";
    EXPECT_EQ(after(2, push).fault, DeviceFault::none);
    EXPECT_GT(glm::length(firmware.force()), 1);
}

TEST_F(Bridge, AForceThatIsNoneIsNotRendered)
{
    bridge.open();
    after(10, push);
    EXPECT_EQ(after(1, notFinite()).fault, DeviceFault::badForce);
    EXPECT_EQ(firmware.force(), glm::dvec3(0));
    EXPECT_EQ(after(1, push).fault, DeviceFault::none);
}

TEST_F(Bridge, AHostThatStayedAwayRendersNothingAtFirst)
{
    bridge.open();
    after(10, push);
    now += 0.11;
    EXPECT_EQ(after(1, push).fault, DeviceFault::hostTooSlow);
    EXPECT_EQ(firmware.force(), glm::dvec3(0));
    EXPECT_EQ(after(1, push).fault, DeviceFault::none);
}

TEST_F(Bridge, TheServosClockMayStartAnew)
{
    bridge.open();
    after(10, push);
    now                     = 0; // a session that starts after homing
    const HapticState state = after(1, push);
    EXPECT_EQ(state.fault, DeviceFault::none);
    EXPECT_EQ(state.time, now);

    now += 0.11;
    EXPECT_EQ(after(1, push).fault, DeviceFault::hostTooSlow) << "counted from the new start";
    after(1, push);
    now                   = 0;
    const double answered = alone(1, push).time;
    EXPECT_LE(answered, now + kStep) << "no answer is of the future; rounding";
    now += 0.05;
    EXPECT_EQ(alone(1, push).fault, DeviceFault::none);
    now += 0.06;
    EXPECT_EQ(alone(1, push).fault, DeviceFault::silent) << "0.1 s without an answer, though three exchanges only";
}

TEST_F(Bridge, APositionThatNoArmHasIsNotBelieved)
{
    bridge.open();
    firmware.answer.position = {0.01, 0, 0};
    after(10, push);
    firmware.answer.position = {0.11, 0, 0}; // more than twice the radius of 0.05
    const HapticState state  = after(1, push);
    EXPECT_EQ(state.fault, DeviceFault::kinematics);
    EXPECT_NEAR(state.position.x, 0.01, kStep) << "it stays where it was last seen";
    EXPECT_FALSE(state.inBox);
    EXPECT_EQ(firmware.force(), glm::dvec3(0));
}

TEST_F(Bridge, UnpluggedStaysUntilItIsOpenedAnew)
{
    bridge.open();
    after(10, push);
    device.unplug();
    EXPECT_EQ(alone(2, push).fault, DeviceFault::unplugged);
    EXPECT_EQ(alone(1, push).fault, DeviceFault::unplugged);
    bridge.close();
    EXPECT_EQ(device.openPorts(), 0);
    EXPECT_THROW(bridge.open(), Error) << "it is not back";
    EXPECT_EQ(bridge.exchange(push, now).fault, DeviceFault::closed);
}

TEST_F(Bridge, ALostWriteIsALostDevice)
{
    bridge.open();
    after(10, push);
    device.refuseWrites();
    EXPECT_EQ(after(2, push).fault, DeviceFault::unplugged);
}

TEST_F(Bridge, CloseAndDestructionSayZeroSeveralTimes)
{
    const auto threeZeros = [&] {
        const std::vector<BridgeCommand> commands = firmware.commands();
        return commands.size() > 3 && std::none_of(commands.end() - 3, commands.end(),
                                                   [](const BridgeCommand& command) { return command.enable; });
    };
    bridge.open();
    after(10, push);
    EXPECT_GT(glm::length(firmware.force()), 1);
    bridge.close();
    EXPECT_TRUE(threeZeros());
    EXPECT_EQ(device.openPorts(), 0);
    {
        HidBridgeDevice second(system, ours(), settings());
        firmware.tick(kTick);
        second.open();
        firmware.tick(kTick);
        second.exchange(push, now += kTick);
        EXPECT_GT(glm::length(firmware.force()), 1);
    }
    EXPECT_TRUE(threeZeros());
    EXPECT_EQ(device.openPorts(), 0);
}

std::string reasonOf(HidBridgeDevice& bridge)
{
    try {
        bridge.open();
    } catch (const Error& error) {
        return error.what();
    }
    return "it was opened";
}

TEST(BridgeOpening, SaysWhyItFails)
{
    FakeHidSystem   system;
    FakeHidDevice&  device = system.plug(ours());
    HidBridgeDevice bridge(system, ours(), {.openWait = 0.01, .pace = HidPace::caller});
    EXPECT_NE(reasonOf(bridge).find("sends no report of a bridge"), std::string::npos) << reasonOf(bridge);
    BridgeBytes later = encode(BridgeAnswer{});
    later[3]          = 0x20;
    device.send(Report(later.begin(), later.end()));
    EXPECT_NE(reasonOf(bridge).find("another version"), std::string::npos);
    EXPECT_EQ(device.openPorts(), 0);
    device.refusal = "no permission";
    EXPECT_NE(reasonOf(bridge).find("no permission; the line that helps"), std::string::npos);
    EXPECT_THROW(HidBridgeDevice(system, ours(), {.watchdog = 1}), Error);
    EXPECT_THROW(HidBridgeDevice(system, ours(), {.openWait = std::numeric_limits<double>::quiet_NaN()}), Error);
}

TEST(BridgeListing, IsKnownByItsPage)
{
    EXPECT_TRUE(isBridge(ours()));
    HidListing other = ours();
    other.usage      = 1;
    EXPECT_FALSE(isBridge(other));
}

} // namespace
} // namespace palp
