// Tests of the bridge's own thread in real time: which side waits, and what happens when exchange() is not called.
#include "device/hid/hid_bridge.h"

#include <chrono>
#include <cstdio>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "device/detail/held_force.h"
#include "tests/device/fake_bridge.h"
#include "tests/device/fake_hid.h"
#include "tests/device/governed.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3;  // [s]
constexpr double kBusy = 50e-3; // [s] that a thread may have to wait for a processor, as it outranks nobody here

/// A device that runs on a thread of its own, in real time.
class BridgeInRealTime : public testing::Test {
protected:
    BridgeInRealTime()
        : firmwareThread_([this](const std::stop_token& stop) {
              while (!stop.stop_requested()) {
                  firmware.tick(kTick);
                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
              }
          })
    {
    }

    [[nodiscard]] double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    /// Ticks on until it is so; false after 10 s, for a busy machine.
    bool until(HidBridgeDevice& bridge, const GovernedForce& force, const std::function<bool(const HapticState&)>& so)
    {
        for (const double end = seconds() + 10; seconds() < end;) {
            if (so(bridge.exchange(force, seconds()))) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }

    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    FakeHidSystem                               system;
    FakeHidDevice&                              device = system.plug(ours());
    FakeBridge                                  firmware{device};
    std::jthread                                firmwareThread_;
};

TEST_F(BridgeInRealTime, AThreadDoesTheReadingAndWriting)
{
    HidBridgeDevice bridge(system, ours(), {.asksForRealTime = false}); // a test must not outrank what else runs
    bridge.open();
    const GovernedForce push = governed({1, 0, 0});
    EXPECT_TRUE(until(bridge, push, [&](const HapticState& state) {
        return state.sequence > 50 && state.fault == DeviceFault::none && firmware.force().x > 0.9;
    }));
    bridge.close();
    EXPECT_EQ(firmware.force(), glm::dvec3(0));
    EXPECT_EQ(device.openPorts(), 0);
}

TEST_F(BridgeInRealTime, AnExchangeNeitherLocksNorAllocates)
{
    HidBridgeDevice bridge(system, ours(), {.asksForRealTime = false});
    bridge.open();
    const GovernedForce push = governed({1, 0, 0});

    const std::size_t locks = locksOfThisThread(), allocations = allocationsOfThisThread();
    for (int n = 0; n < 100000; ++n) bridge.exchange(push, n * kTick);
    EXPECT_EQ(locksOfThisThread(), locks) << "the fake's mutex would show, so no port was touched";
    EXPECT_EQ(allocationsOfThisThread(), allocations);
    static_cast<void>(device.written());
    EXPECT_EQ(locksOfThisThread() > locks, locksAreCounted()) << "written() takes one";
}

TEST_F(BridgeInRealTime, TheForceFallsByItselfWhenNobodyCalls)
{
    // A watchdog that is out of the way, and a thread that must not outrank what else runs.
    HidBridgeDevice bridge(system, ours(), {.watchdog = 0.255, .asksForRealTime = false});
    bridge.open();
    const GovernedForce push  = governed({1, 0, 0});
    int                 steps = 0; // [1] on the way down; on a busy machine the thread may miss them all, so thrice
    for (int trial = 0; trial < 3; ++trial) {
        ASSERT_TRUE(until(bridge, push, [&](const HapticState&) { return firmware.force().x > 0.9995; }));
        const std::size_t before = firmware.commands().size();
        bridge.exchange(push, seconds());
        const auto left = std::chrono::steady_clock::now();
        std::this_thread::sleep_for(std::chrono::milliseconds(200));

        const std::vector<BridgeCommand> commands = firmware.commands();
        const auto                       times    = firmware.times();
        double                           zero     = -1; // [s] after the call
        for (std::size_t n = before; n < commands.size(); ++n) {
            const double age = std::chrono::duration<double>(times[n] - left).count(), force = commands[n].force.x;
            if (zero < 0 && !commands[n].enable) zero = age;
            steps += force > 0.05 && force < 0.95;
            EXPECT_EQ(commands[n].enable, zero < 0) << "zero is not the end of it";
            EXPECT_LE(force, heldShare(age - kBusy) + 2e-3) << "no later; a step of the field";
        }
        std::printf("  zero after %.1f ms\n", zero * 1e3);
        EXPECT_GE(zero, 25e-3 - 2e-3) << "held, then let fall; the call itself takes a moment";
        EXPECT_LE(zero, 25e-3 + kBusy);
        EXPECT_GE(commands.size(), before + 4) << "it is said over and over";
        EXPECT_EQ(firmware.force(), glm::dvec3(0));
        EXPECT_EQ(bridge.exchange(push, seconds()).fault, DeviceFault::hostTooSlow);
    }
    EXPECT_GE(steps, 3);
}

TEST_F(BridgeInRealTime, UnpluggingEndsTheThreadWithAFault)
{
    HidBridgeDevice bridge(system, ours(), {.asksForRealTime = false}); // a test must not outrank what else runs
    bridge.open();
    device.unplug();
    EXPECT_TRUE(until(bridge, {}, [](const HapticState& state) { return state.fault == DeviceFault::unplugged; }));
}

} // namespace
} // namespace palp
