// Tests of the Falcon's driver on the emulated Falcon, in virtual time.
#include "device/falcon/falcon_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/simulated_arm.h"
#include "engine/core/contract.h"
#include "tests/device/falcon_bench.h"

namespace palp {
namespace {

constexpr double kCount = 55e-6; // [m] most that one count moves the grip, by the singular values of the Jacobian

TEST(FalconDevice, TheHandFeelsTheForceAskedFor)
{
    for (const glm::dvec3& wanted : {glm::dvec3(2, 0, 0), glm::dvec3(0, -3, 0), glm::dvec3(1, 2, -3)})
        for (const glm::dvec3& place : {glm::dvec3(0), glm::dvec3(0.02, -0.01, -0.015)}) {
            glm::dvec3  felt{};
            FalconBench bench(runningFalcon(), [&](const glm::dvec3& force, double dt) {
                if (dt > 0) felt = force;
                return place;
            });
            bench.force = governed(wanted);

            bench.run(0.1);

            EXPECT_EQ(bench.state.fault, DeviceFault::none);
            EXPECT_NEAR(glm::length(felt - wanted), 0, 0.02)
                << "half a count is 1.2e-4 N m on a lever of 25 mm, and the position is off by a count";
        }
}

TEST(FalconDevice, PositionAndVelocityAreTheHands)
{
    double     clock = 0; // s
    const auto way   = [](double t) {
        return glm::dvec3(0.02 * std::sin(6 * t), 0.02 * std::cos(5 * t) - 0.02, 0.015 * std::sin(4 * t));
    };
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double dt) { return way(clock += dt); });

    double worstPlace = 0, worstSpeed = 0;
    bench.run(0.02);
    bench.run(3, [&] {
        const double t = bench.state.time; // the arm's clock is the emulator's
        worstPlace     = std::max(worstPlace, glm::length(bench.state.position - way(t)));
        // Over a window of 15 ms and back to its middle.
        const glm::dvec3 velocity = (way(t) - way(t - 15e-3)) / 15e-3;
        worstSpeed                = std::max(worstSpeed, glm::length(bench.state.velocity - velocity));
    });

    std::printf("  worst error of the position %.0f um, of the velocity %.4f m/s\n", worstPlace * 1e6, worstSpeed);
    EXPECT_LE(worstPlace, kCount + 0.2 * 1e-3) << "a count, and 0.2 m/s for the millisecond that an answer is old";
    EXPECT_LE(worstSpeed, 2 * kCount / 15e-3 + 0.2 * 5 * 2e-3) << "a count at each end; 1 m/s2 for 2 ms";
    EXPECT_TRUE(bench.state.homed && bench.state.inBox);
}

TEST(FalconDevice, UnhomedItNeverPushesAndHomingIsNoSpeed)
{
    // Out by 45 mm, in by 100 at 0.1 m/s, and back to the middle: the legs are homed at the end of the way in.
    double     clock = 0;
    const auto way   = [](double t) {
        if (t < 0.5) return 0.0;
        if (t < 1.0) return 0.09 * (t - 0.5);
        if (t < 1.95) return 0.045 - 0.1 * (t - 1.0);
        return std::min(0.0, -0.05 + 0.1 * (t - 1.95));
    };
    Ft232EmulatorSettings settings = runningFalcon();
    settings.falcon.homed          = false;
    FalconBench bench(settings, [&](const glm::dvec3&, double dt) { return glm::dvec3(0, 0, way(clock += dt)); });
    bench.force = governed({0, 0, 2});
    bench.device->light(std::uint8_t(DeviceLight::green));

    double fastest = 0, homedAt = -1;
    bench.run(3, [&] {
        fastest = std::max(fastest, glm::length(bench.state.velocity));
        if (bench.state.homed && homedAt < 0) homedAt = bench.emulator.now();
        EXPECT_EQ(bench.state.fault, DeviceFault::none);
        if (bench.state.homed) return;
        ASSERT_FALSE(bench.pushes());
        EXPECT_TRUE(bench.emulator.falcon().command().homing);
        EXPECT_EQ(bench.emulator.falcon().command().lights, std::uint8_t(DeviceLight::red));
        EXPECT_FALSE(bench.state.inBox);
    });

    EXPECT_NEAR(homedAt, 1.95, 0.15) << "at the inner stop";
    EXPECT_LE(fastest, 0.1 + 2 * kCount / 1e-3) << "the hand's, and a count at each end of the first millisecond";
    EXPECT_FALSE(bench.emulator.falcon().command().homing);
    EXPECT_EQ(bench.emulator.falcon().command().lights, std::uint8_t(DeviceLight::green));
    EXPECT_TRUE(bench.pushes());
    bench.device->light(std::uint8_t(DeviceLight::blue));
    bench.tick();
    EXPECT_EQ(bench.emulator.falcon().command().lights, std::uint8_t(DeviceLight::blue)) << "the governor waits";
}

TEST(FalconDevice, OutsideItsWorkspaceItDoesNotPush)
{
    glm::dvec3  place{};
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double) { return place; });
    bench.force = governed({1, 0, 0});
    bench.device->light(std::uint8_t(DeviceLight::green));
    bench.run(0.1);
    ASSERT_TRUE(bench.pushes());

    for (int n = 0; n < 50; ++n) { // at 1 m/s
        place.z += 1e-3;
        bench.tick();
    }
    bench.run(0.01);

    EXPECT_FALSE(bench.state.inBox);
    EXPECT_FALSE(bench.pushes());
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_EQ(bench.emulator.falcon().command().lights, std::uint8_t(DeviceLight::blue));
}

TEST(FalconDevice, ASlowServosForceComesOnNoFaster)
{
    FalconBench bench;
    bench.force = governed({0, 0, 4});
    bench.run(0.1);
    const int full = bench.emulator.falcon().motors()[0];

    bench.now += 0.05; // the last answer is stale
    bench.tick();
    EXPECT_FALSE(bench.pushes());
    bench.now += 9e-3;
    bench.tick();

    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_TRUE(bench.pushes());
    EXPECT_LE(std::abs(bench.emulator.falcon().motors()[0]), std::abs(full) * 0.21) << "4 ms of 20, and rounding";
}

struct Trouble {
    const char*     name;
    LinkTroubleKind kind;
    double          lasts;        // [s]
    DeviceFault     fault;        // expected
    bool            isOver;       // whether force flows again afterwards
    bool            hears = true; // the device still hears what it is told
};

TEST(FalconDevice, EveryLastingFaultEndsAtZeroForceWithin20ms)
{
    const double forever = std::numeric_limits<double>::infinity();
    for (const Trouble& trouble :
         {Trouble{"runts", LinkTroubleKind::runt, forever, DeviceFault::garbled, false},
          Trouble{"silence", LinkTroubleKind::silence, forever, DeviceFault::silent, false},
          Trouble{"unplugged", LinkTroubleKind::unplug, forever, DeviceFault::unplugged, false, false},
          Trouble{"unplugged for 30 ms", LinkTroubleKind::unplug, 0.03, DeviceFault::unplugged, false, false},
          Trouble{"stall of 100 ms", LinkTroubleKind::stall, 0.1, DeviceFault::silent, true, false},
          Trouble{"silence of 100 ms", LinkTroubleKind::silence, 0.1, DeviceFault::silent, true},
          Trouble{"runts for 100 ms", LinkTroubleKind::runt, 0.1, DeviceFault::garbled, true}}) {
        FalconBench bench;
        bench.force = governed({1, -1, 2});
        bench.run(0.2);
        ASSERT_TRUE(bench.pushes());
        const double from = bench.emulator.now();
        bench.emulator.cause({trouble.kind, from, from + trouble.lasts});

        double      quiet = -1; // [s] when the motors first let go
        DeviceFault fault = DeviceFault::none;
        bench.run(std::min(trouble.lasts, 0.3), [&] {
            if (!bench.pushes() && quiet < 0) quiet = bench.emulator.falcon().lastTorque();
            fault = std::max(fault, bench.state.fault);
            if (quiet >= 0 && bench.emulator.now() < from + trouble.lasts) { // what a stall kept back comes after it
                EXPECT_FALSE(bench.pushes()) << "once gone, it stays so: " << trouble.name;
            }
        });
        const double gone = quiet - from;
        bench.run(0.3, [&] { fault = std::max(fault, bench.state.fault); });

        std::printf("  %-20s motors at zero after %4.1f ms\n", trouble.name, gone * 1e3);
        EXPECT_EQ(fault, trouble.fault) << trouble.name << ": " << name(fault);
        EXPECT_GE(quiet, 0) << trouble.name;
        // Told so: 10 ms without an answer, an exchange of 2.5 ms. Else the firmware's hold of 20 ms.
        EXPECT_LE(gone, trouble.hears ? 13e-3 : 20e-3) << trouble.name;
        EXPECT_EQ(bench.state.fault, trouble.isOver ? DeviceFault::none : trouble.fault) << trouble.name;
        EXPECT_EQ(bench.pushes(), trouble.isOver) << trouble.name;
    }
}

TEST(FalconDevice, AfterAFaultTheForceComesOnSlowly)
{
    FalconBench bench;
    bench.force = governed({0, 0, 4});
    bench.run(0.2);
    const int full = bench.emulator.falcon().motors()[0];
    bench.emulator.cause({LinkTroubleKind::silence, bench.emulator.now(), bench.emulator.now() + 0.1});

    int last = full, most = 0;
    bench.run(0.3, [&] {
        const int count = bench.emulator.falcon().motors()[0];
        most            = std::max(most, std::abs(count) - std::abs(last));
        last            = count;
    });

    EXPECT_EQ(last, full);
    EXPECT_LE(most, std::abs(full) * 0.21) << "in 20 ms, of which a tick has at most 4";
}

TEST(FalconDevice, ShortTroublesAreMissedAnswersAndNoFault)
{
    for (const Trouble& trouble : {Trouble{"a runt", LinkTroubleKind::runt, 1e-3, DeviceFault::none, true},
                                   Trouble{"merged", LinkTroubleKind::merged, 20e-3, DeviceFault::none, true},
                                   Trouble{"split", LinkTroubleKind::split, 20e-3, DeviceFault::none, true},
                                   Trouble{"garbage", LinkTroubleKind::garbage, 20e-3, DeviceFault::none, true},
                                   Trouble{"repeated", LinkTroubleKind::repeat, 20e-3, DeviceFault::none, true},
                                   Trouble{"stall of 5 ms", LinkTroubleKind::stall, 5e-3, DeviceFault::none, true},
                                   Trouble{"stall of 20 ms", LinkTroubleKind::stall, 20e-3, DeviceFault::none, true}}) {
        FalconBench bench;
        bench.force = governed({1, -1, 2});
        bench.run(0.2);
        bench.emulator.cause({trouble.kind, bench.emulator.now(), bench.emulator.now() + trouble.lasts});

        int most = 0;
        bench.run(0.1, [&] {
            most = std::max(most, bench.state.missed);
            EXPECT_EQ(bench.state.fault, DeviceFault::none) << trouble.name;
            EXPECT_LE(glm::length(bench.state.position), kCount) << trouble.name << ": it rests in the middle";
        });

        std::printf("  %-15s at most %d missed in a row\n", trouble.name, most);
        EXPECT_EQ(bench.state.missed, 0) << trouble.name;
        EXPECT_TRUE(bench.pushes()) << trouble.name;
    }
}

TEST(FalconDevice, NoAnswerStaysBehindAfterRepeatedOnes)
{
    struct Case {
        bool   isHurried; // with the event character, an exchange after the other; else one a tick
        double age;       // [s] of an answer, at most
    };
    for (const auto& [isHurried, age] : {Case{false, 1.2e-3}, Case{true, 0.5e-3}}) {
        double               clock = 0;
        FalconDeviceSettings settings;
        settings.start.triesEventCharacter = isHurried;
        FalconBench bench(
            runningFalcon(),
            [&](const glm::dvec3&, double dt) {
                clock += dt;
                return glm::dvec3(0.02 * std::sin(50 * clock), 0, 0); // up to 1 m/s
            },
            settings);
        const auto run = [&, isHurried = isHurried](double seconds) {
            double worst = 0;
            for (const double until = bench.emulator.now() + seconds; bench.emulator.now() < until;) {
                bench.tick();
                if (isHurried) bench.now = bench.emulator.now();
                worst = std::max(worst, glm::length(bench.state.position - bench.emulator.falcon().position()));
            }
            return worst;
        };
        run(0.1);
        bench.emulator.cause({LinkTroubleKind::repeat, bench.emulator.now(), bench.emulator.now() + 20e-3});
        run(0.1);

        EXPECT_LE(run(1), kCount + 1 * age) << "a count, and 1 m/s for the age of one answer";
    }
}

TEST(FalconDevice, SteppedItFollowsTheServosClock)
{
    FalconDeviceSettings settings;
    settings.start.triesEventCharacter = true; // an exchange takes half a tick
    FalconBench  bench(runningFalcon(), {}, settings);
    const double from = bench.emulator.now();
    for (int n = 0; n < 1000; ++n) {
        const double now = 100 + n * 1e-3; // s
        bench.state      = bench.device->exchange({}, now);
        ASSERT_NEAR(bench.emulator.now() - from, n * 1e-3 + 0.5e-3, 0.1e-3) << "the exchange of this tick";
        ASSERT_NEAR(bench.state.time - bench.state.age, now, 0.1e-3) << "its packet left at this tick";
    }
}

TEST(FalconDevice, AJumpOfTheEncodersIsNoSpeed)
{
    glm::dvec3  place{-0.015, 0, 0};
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double) { return place; });
    bench.run(0.1);
    place.x = 0.015;

    bench.run(0.05, [&] { EXPECT_LE(glm::length(bench.state.velocity), 2 * kCount / 1e-3) << "a count at each end"; });

    EXPECT_NEAR(bench.state.position.x, 0.015, kCount) << "believed in the end";
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
}

TEST(FalconDevice, HomingLostAndFoundElsewhereIsNoSpeed)
{
    glm::dvec3  place{-0.015, 0, 0};
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double) { return place; });
    bench.force = governed({1, 0, 0});
    bench.run(0.1);

    place = {1, 0, 0}; // out of its own reach the emulated one says that it is not homed
    bench.run(0.005);
    bench.run(0.01, [&] {
        EXPECT_FALSE(bench.state.homed || bench.state.inBox || bench.pushes());
        EXPECT_EQ(bench.emulator.falcon().command().lights, std::uint8_t(DeviceLight::red));
    });
    for (double x : {0.015, -0.015, 0.015}) {
        place = {1, 0, 0};
        bench.run(0.002); // too short for 30 mm at a speed that would be believed
        place = {x, 0, 0};
        bench.run(0.002);
        bench.run(0.05, [&] {
            EXPECT_NEAR(bench.state.position.x, x, kCount) << "with the first answer";
            EXPECT_LE(glm::length(bench.state.velocity), 2 * kCount / 1e-3) << "a count at each end";
        });
    }
}

TEST(FalconDevice, AnOldAnswerIsNotBelieved)
{
    // 50 packets ago the hand was 15 mm away.
    double      clock = 0;
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double dt) {
        clock += dt;
        return glm::dvec3(clock < 0.3 ? -0.03 : std::min(0.03, -0.03 + 0.3 * (clock - 0.3)), 0, 0);
    });
    bench.run(0.4 - bench.emulator.now());
    bench.emulator.cause({LinkTroubleKind::replay, 0.4, 0.402});

    int missed = 0;
    bench.run(0.05, [&] {
        missed += bench.state.missed;
        EXPECT_LE(glm::length(bench.state.velocity), 0.3 * 16 / 15 + 2 * kCount / 15e-3)
            << "the hand's; the timer's phase moves by up to 1 ms in the window of 15, and a count at each end";
        EXPECT_LE(glm::length(bench.state.position - bench.emulator.falcon().position()), 2e-3)
            << "0.3 m/s for the 5 ms or so until the next good answer";
        EXPECT_EQ(bench.state.fault, DeviceFault::none);
    });

    EXPECT_GE(missed, 1) << "or there was nothing to disbelieve";
}

TEST(FalconDevice, EncodersThatNoArmCanHaveAreAFault)
{
    // Thighs read 52 degrees too far out, at 170 mm where they stand at 67: no shin is that long.
    Ft232EmulatorSettings settings     = runningFalcon();
    settings.falcon.geometry.zeroAngle = FalconGeometry{}.zeroAngle - 0.9; // [rad]
    FalconBench bench(settings, [](const glm::dvec3&, double) { return glm::dvec3(0, 0, 0.045); });
    bench.force = governed({0, 0, 1});

    bench.run(0.1, [&] {
        EXPECT_FALSE(bench.state.inBox);
        EXPECT_FALSE(bench.pushes());
    });

    EXPECT_EQ(bench.state.fault, DeviceFault::kinematics);
}

TEST(FalconDevice, AForceThatIsNotFiniteIsNone)
{
    FalconBench bench;
    bench.force = governed({1, 0, 0});
    bench.run(0.1);
    ASSERT_TRUE(bench.pushes());
    const GovernedForce good = bench.force;

    bench.force = good.rotated({std::numeric_limits<double>::quiet_NaN(), 0, 0, 0});
    bench.run(0.02, [&] {
        EXPECT_EQ(bench.state.fault, DeviceFault::badForce);
        EXPECT_FALSE(bench.pushes());
    });
    bench.force = good;
    bench.run(0.1);

    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_TRUE(bench.pushes());
}

TEST(FalconDevice, NotCalledItsForceEndsAndItSaysSo)
{
    FalconBench bench;
    bench.force = governed({1, 0, 0});
    bench.run(0.1);
    ASSERT_TRUE(bench.pushes());
    const double left = bench.emulator.now();

    bench.emulator.waitUntil(left + 0.15);
    bench.now = bench.emulator.now();
    EXPECT_LE(bench.emulator.falcon().lastTorque(), left + 20e-3) << "the firmware's hold";
    bench.tick();

    EXPECT_EQ(bench.state.fault, DeviceFault::hostTooSlow);
    EXPECT_FALSE(bench.pushes());
    bench.tick();
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
}

TEST(FalconDevice, ClosedOrDestroyedItLeavesNoForce)
{
    for (const bool isDestroyed : {false, true}) {
        Ft232EmulatorSettings settings = runningFalcon();
        settings.falcon.holdTime       = 1e6; // s: a firmware that never lets go
        FalconBench bench(settings);
        bench.force = governed({1, 0, 0});
        bench.run(0.1);
        ASSERT_TRUE(bench.pushes());
        const auto before = bench.emulator.falcon().packets();

        if (isDestroyed)
            bench.device.reset();
        else
            bench.device->close();
        bench.emulator.waitUntil(bench.emulator.now() + 2e-3);

        EXPECT_FALSE(bench.pushes());
        EXPECT_GE(bench.emulator.falcon().packets(), before + 3);
        EXPECT_EQ(bench.emulator.falcon().command(), FalconCommand{}) << "lights off as well";
    }
}

TEST(FalconDevice, OpensAndClosesManyTimes)
{
    FalconBench bench;
    for (int n = 0; n < 50; ++n) {
        bench.device->close();
        bench.device->close();
        EXPECT_EQ(bench.device->exchange({}, bench.now).fault, DeviceFault::closed);
        bench.device->open();
        bench.device->open();
        bench.now = bench.emulator.now();
        bench.run(0.01);
        EXPECT_EQ(bench.state.fault, DeviceFault::none);
        EXPECT_GE(bench.state.sequence, 5u);
    }
}

TEST(FalconDevice, UnpluggedItOpensAgainOnceItIsBack)
{
    FalconBench bench;
    bench.emulator.cause({LinkTroubleKind::unplug, 0.1, 0.3});
    bench.run(0.2);
    ASSERT_EQ(bench.state.fault, DeviceFault::unplugged);
    EXPECT_FALSE(bench.state.homed || bench.state.inBox);

    bench.device->close();
    EXPECT_THROW(bench.device->open(), Error) << "still away";
    bench.emulator.waitUntil(0.4);
    bench.device->open();
    bench.now = bench.emulator.now();
    bench.run(0.1);

    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_TRUE(bench.state.homed) << "it kept its power";
}

TEST(FalconDevice, WithoutPowerItIsSilentAndOpensAgainByUpload)
{
    FalconDeviceSettings settings;
    settings.firmware = std::vector<std::uint8_t>(8492, 7);
    FalconBench bench(runningFalcon(), {}, settings);
    bench.run(0.1);
    bench.emulator.falcon().powerCycle();
    bench.run(0.2);
    EXPECT_EQ(bench.state.fault, DeviceFault::silent);

    bench.device->close();
    bench.device->open();
    bench.now = bench.emulator.now();
    bench.run(0.1);

    EXPECT_EQ(bench.emulator.falcon().image(), settings.firmware);
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_FALSE(bench.state.homed) << "it has to be homed anew";
}

TEST(FalconDevice, ButtonsAndLightsPassThrough)
{
    FalconDeviceSettings settings;
    settings.loop.showsState = false;
    FalconBench bench(runningFalcon(), {}, settings);
    bench.emulator.falcon().press(9);
    bench.device->light(5);

    bench.run(0.01);

    EXPECT_EQ(bench.state.buttons, 9u);
    EXPECT_EQ(bench.emulator.falcon().command().lights, 5);
}

TEST(FalconDevice, TheRateIsTheTimersOrTheWires)
{
    const auto rate = [](bool eventCharacter) { // [Hz] of answers, as fast as it goes
        FalconDeviceSettings settings;
        settings.start.triesEventCharacter = eventCharacter;
        FalconBench  bench(runningFalcon(), {}, settings);
        const double from = bench.emulator.now();
        for (int n = 0; n < 1000; ++n) bench.state = bench.device->exchange({}, bench.emulator.now());
        EXPECT_EQ(bench.state.sequence, 1000u);
        return 1000 / (bench.emulator.now() - from);
    };
    const double timer = rate(false), event = rate(true);

    std::printf("  exchanges: %.0f Hz with a timer of 1 ms, %.0f Hz with the event character\n", timer, event);
    EXPECT_NEAR(timer, 1000, 2) << "one a period of the timer, but for the first";
    EXPECT_GT(event, 1800) << "two transfers, two wires and the firmware: 514 us";
}

TEST(FalconDevice, TheServosClockMayStartAnew)
{
    FalconBench bench;
    bench.run(5);
    const double before = bench.emulator.now();

    double now = 0, worst = 0; // [s]
    for (; now < 1; now += 2e-3) {
        const HapticState state = bench.device->exchange({}, now);
        EXPECT_EQ(state.fault, DeviceFault::none);
        worst = std::max(worst, std::abs(state.time - now));
    }

    EXPECT_NEAR(bench.emulator.now() - before, now, 5e-3) << "both go on alike";
    EXPECT_LE(worst, 2e-3) << "an answer takes 1 to 1.5 ms";
}

TEST(FalconDevice, AWallIsFeltThroughTheWholeChain)
{
    // A hand of 150 N/m pulls 5 mm into a wall of 500 N/m at z = 0: it rests where 500 d = 150 (5 mm - d).
    SimulatedArmSettings of;
    of.encoderStep = 0, of.delayTicks = 0;
    SimulatedArm arm(of, {0, 0, 0.01});
    arm.holdBy({.stiffness = 150, .damping = 3, .target = {0, 0, 0.01}});
    FalconBench   bench(runningFalcon(), [&](const glm::dvec3& force, double dt) {
        arm.step(force, dt);
        return arm.position();
    });
    ForceGovernor governor;
    const auto    touch = [&] {
        GovernorInput in;
        in.force    = {0, 0, std::max(0.0, -500 * bench.state.position.z)};
        in.position = bench.state.position;
        in.velocity = bench.state.velocity;
        in.homed    = bench.state.homed;
        in.inBox    = bench.state.inBox;
        in.dt       = 1e-3;
        governor.step(in);
        bench.force = governor.force();
    };
    bench.run(2, touch);
    arm.holdBy({.stiffness = 150, .damping = 3, .target = {0, 0, -0.005}});
    bench.run(3, touch);

    EXPECT_EQ(governor.fault(), GovernorFault::none);
    EXPECT_NEAR(arm.position().z, -0.005 * 150 / 650, kCount) << "a count of the position";
    EXPECT_NEAR(bench.force.newtons().z, 500 * 0.005 * 150 / 650, 500 * kCount) << "the same";
}

} // namespace
} // namespace palp
