// The loop with a Falcon as it runs in real time, in virtual time: the driver's conversation goes on as fast as the
// line lets it, the servo ticks each millisecond on a phase of its own, reads the newest answer and leaves its force.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_loop.h"
#include "device/falcon/ft232_emulator.h"
#include "device/simulated_arm.h"
#include "engine/force/energy_tank.h"
#include "engine/force/governor.h"
#include "engine/session/servo.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3; // [s] of the servo

/// A line to a Falcon.
struct Line {
    double   transfer       = 125e-6; // [s]
    unsigned timer          = 1;      // [ms] of the bridge's latency
    bool     eventful       = false;  // with the event character
    bool     isHandedAtOnce = true;   // the force of a tick leaves with the next packet; false: that of the tick before

    [[nodiscard]] std::string name() const
    {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "transfers %4.0f us, %s", transfer * 1e6,
                      eventful     ? "event character"
                      : timer == 1 ? "timer 1 ms"
                                   : "timer 4 ms");
        return text.data();
    }
};

std::vector<Line> lines()
{
    std::vector<Line> all;
    for (double transfer : {125e-6, 500e-6, 1e-3})
        for (auto [timer, eventful] : {std::pair{1U, false}, {4U, false}, {1U, true}})
            all.push_back({transfer, timer, eventful});
    return all;
}

/// An arm without encoder steps or delay of its own: the emulator has both.
SimulatedArmSettings bareArm(double mass = 0.46, double damping = 3.2)
{
    SimulatedArmSettings arm;
    arm.mass        = mass;
    arm.damping     = damping;
    arm.encoderStep = 0;
    arm.delayTicks  = 0;
    return arm;
}

/// What a tick reads.
struct Reading {
    HapticState state{};
    double      time   = 0; // [s] of the servo
    double      period = 0; // [s] of the exchanges
    double      dt     = 0; // [s] since the last tick

    [[nodiscard]] GovernorInput input() const
    {
        GovernorInput in;
        in.position       = state.position;
        in.velocity       = state.velocity;
        in.homed          = state.homed && state.fault == DeviceFault::none;
        in.inBox          = state.inBox;
        in.dt             = dt;
        in.answerAge      = state.age;
        in.sinceAnswer    = time - state.time;
        in.exchangePeriod = period;
        return in;
    }
};

/// Returns the force of a tick [N].
using Tick = std::function<glm::dvec3(const Reading&)>;

struct Rig {
    Line                        line;
    SimulatedArm                arm;
    Ft232Emulator               emulator;
    std::unique_ptr<FalconLoop> loop;
    HapticState                 newest{}; // as the driver's thread has published it
    AnswerPeriod                answers;
    double                      next  = 0; // [s] of the next tick
    double                      last  = 0; // [s] of the last one
    double                      begun = 0; // [s]
    glm::dvec3                  handed{}, kept{};
    unsigned                    exchanges = 0;

    Rig(const Line& on, const SimulatedArmSettings& of, const glm::dvec3& start, double phase = 0.4e-3)
        : line(on), arm(of, start), emulator(settings(on), [this](const glm::dvec3& force, double dt) {
              arm.step(force, dt);
              return arm.position();
          })
    {
        FalconStartSettings how;
        how.triesEventCharacter = line.eventful;
        StartedFalcon started   = startFalcon([this] { return emulator.connect(); }, {}, how);
        started.link->control(FtdiRequest::latencyTimer, std::uint16_t(line.timer));
        FalconLoopSettings patient;
        patient.answerTimeout = 20e-3; // the timer of 4 ms keeps an answer for longer than a driver waits for it
        loop                  = std::make_unique<FalconLoop>(std::move(started.link), patient);
        newest.fault          = DeviceFault::startingUp;
        begun                 = emulator.now();
        next                  = begun + phase;
        last                  = next - kTick;
    }

    static Ft232EmulatorSettings settings(const Line& line)
    {
        Ft232EmulatorSettings settings;
        settings.falcon.running = settings.falcon.homed = true;
        settings.transferTime                           = line.transfer;
        return settings;
    }

    [[nodiscard]] double time() const { return emulator.now() - begun; } // [s]

    /// The servo does nothing for so long [s].
    void delay(double late) { next = last + late; }

    void run(double seconds, const Tick& tick)
    {
        for (const double until = time() + seconds; time() < until;) {
            const HapticState state = loop->exchange({.force = handed});
            ++exchanges;
            for (; next <= emulator.now();
                 last = next, next += kTick) { // those during this exchange know the answer before
                if (newest.fault == DeviceFault::startingUp) continue;
                const double     period = answers.add(newest.sequence, newest.time);
                const glm::dvec3 force  = tick({newest, next, period, next - last});
                handed                  = line.isHandedAtOnce ? force : kept;
                kept                    = force;
            }
            newest = state;
        }
    }
};

/// Returns the amplitude of a released arm on a two-sided spring late in two seconds, by that early [1].
double growth(const Line& line, const SimulatedArmSettings& arm, double stiffness, double phase)
{
    Rig        rig(line, arm, {0, 1e-3, 0}, phase);
    const Tick spring = [&](const Reading& now) { return glm::dvec3(0, -stiffness * now.state.position.y, 0); };
    const auto most   = [&](double seconds) {
        double far = 0;
        rig.run(seconds, [&](const Reading& now) {
            far = worse(far, rig.arm.position().y);
            return spring(now);
        });
        return far;
    };
    rig.run(0.15, spring);
    const double early = most(0.4);
    rig.run(1.05, spring);
    return most(0.4) / early;
}

bool settles(const Line& line, const SimulatedArmSettings& arm, double stiffness)
{
    const auto decays = [&](double phase) { return growth(line, arm, stiffness, phase) < 1; };
    return decays(0.1e-3) && decays(0.6e-3); // of the servo against the line
}

/// Returns the largest stiffness on which a released arm comes to rest, to 1 % [N/m].
double largestStable(const Line& line)
{
    double low = 100, high = 4000;
    while (high > 1.01 * low) {
        const double middle                             = std::sqrt(low * high);
        (settles(line, bareArm(), middle) ? low : high) = middle;
    }
    return low;
}

GovernorSettings governorOf(const SimulatedArmSettings& arm, double most)
{
    GovernorSettings settings;
    settings.mass             = arm.mass;
    settings.ownDamping       = arm.damping;
    settings.maximumStiffness = most;
    return settings;
}

/// What the session does with a wall through the origin, whose outside is above: law, tank, governor.
struct Wall {
    ForceGovernor  governor;
    EnergyTank     tank{};
    GovernorOutput out{};
    double         stiffness = 0; // [N/m]
    bool           twoSided  = false;

    glm::dvec3 tick(const Reading& now)
    {
        GovernorInput in    = now.input();
        const double  depth = twoSided ? -in.position.y : std::max(0.0, -in.position.y);
        const auto    paid  = tank.step({.stiffness    = std::min(stiffness, governor.stiffnessCap()),
                                         .depth        = std::abs(depth),
                                         .normalSpeed  = in.velocity.y,
                                         .dt           = now.dt,
                                         .spareDamping = governor.spareDamping()});
        in.force            = {0, paid.stiffness * depth, 0};
        in.stiffness        = paid.stiffness;
        in.admittedEnergy   = paid.used;
        in.storedEnergy     = paid.stored;
        out                 = governor.step(in);
        return out.force;
    }
};

struct Pressed {
    double        swing = 0;            // [m] of the grip in the last second
    double        least = 10, most = 0; // [N] likewise
    double        cap   = 0;            // [N/m]
    double        lag   = 0;            // [s]
    GovernorFault fault = GovernorFault::none;
};

/// A hand that rests on a wall of 866 N/m, the wart of the palm, presses it 2 mm in within half a second as people move
/// a hand, and stays there.
constexpr double kWart = 866, kDepth = 2e-3, kWait = 0.5; // [N/m], [m], [s]

/// Returns the way of a hand that begins and ends at rest, by its length, after a share of its time [1].
double calmWay(double share)
{
    const double s = std::min(1.0, share);
    return s * s * s * (10 - 15 * s + 6 * s * s);
}

Pressed press(const Line& line, const SimulatedArmSettings& arm, double handsDamping, const GovernorSettings& governed,
              double seconds = 0.5)
{
    Rig           rig(line, arm, {});
    SimulatedHand hand{.stiffness = 150, .damping = handsDamping};
    Wall          wall{ForceGovernor(governed)};
    wall.stiffness = kWart;
    rig.arm.holdBy(hand);
    rig.run(2, [&](const Reading& now) { return wall.tick(now); });
    EXPECT_EQ(wall.out.gain, 1);

    const double felt = std::min(kWart, wall.governor.stiffnessCap());
    const double deep = kDepth * (1 + felt / hand.stiffness), from = rig.time(); // where the hand's spring must go
    Pressed      end;
    double       low = 1, high = -1;
    rig.run(seconds + kWait + 4, [&](const Reading& now) {
        hand.target.y    = -deep * calmWay((rig.time() - from) / seconds);
        const auto force = wall.tick(now);
        rig.arm.holdBy(hand);
        if (rig.time() - from < seconds + kWait) return force;
        low = std::min(low, rig.arm.position().y), high = std::max(high, rig.arm.position().y);
        end.least = std::min(end.least, force.y), end.most = std::max(end.most, force.y);
        return force;
    });
    end.swing = high - low;
    end.fault = wall.governor.fault();
    end.cap   = wall.governor.stiffnessCap();
    end.lag   = wall.governor.lag();
    return end;
}

TEST(FalconLag, TheCapIsAFifthBelowWhatTheReleasedArmBearsOnEveryLine)
{
    for (const Line& line : lines()) {
        Wall wall{ForceGovernor(governorOf(bareArm(), 4000))}; // the law alone: what a device states may be less
        Rig  rig(line, bareArm(), {});
        rig.run(1, [&](const Reading& now) { return wall.tick(now); });
        const double cap = wall.governor.stiffnessCap(), stable = largestStable(line);
        std::printf("  %-34s %4.0f exchanges/s, lag %5.2f ms: cap %4.0f of %4.0f N/m\n", line.name().c_str(),
                    rig.exchanges / rig.time(), wall.governor.lag() * 1e3, cap, stable);
        EXPECT_NEAR(cap / stable, 0.8, 0.02) << line.name() << ": 1 % is the search's, 1 % are counts of the encoders";
    }
}

TEST(FalconLag, ReleasedAtTheCapTheArmSettlesOnEveryLine)
{
    for (const Line& line : lines()) {
        Wall       wall{ForceGovernor(governorOf(bareArm(), 4000))};
        Rig        rig(line, bareArm(), {});
        const Tick tick = [&](const Reading& now) { return wall.tick(now); };
        const auto most = [&](double seconds) {
            double far = 0;
            rig.run(seconds, [&](const Reading& now) {
                far = worse(far, rig.arm.position().y);
                return tick(now);
            });
            return far;
        };
        wall.twoSided  = true;
        wall.stiffness = 4000;
        rig.run(2, tick); // engages at rest
        rig.arm.holdBy({.stiffness = 2000, .damping = 40, .target = {0, 1e-3, 0}});
        rig.run(0.3, tick);
        rig.arm.holdBy({});

        const double released = most(1);
        rig.run(3, tick);
        const double left = most(1);

        EXPECT_EQ(wall.out.gain, 1);
        EXPECT_GT(released, 0.4e-3) << line.name() << ": or the test says nothing";
        EXPECT_LT(left, 0.1e-3) << line.name() << ": two counts of the encoders, which keep it awake";
    }
}

/// The limit is the driver's as before this law: one tick later, the same line bears much less.
TEST(FalconLag, AForceThatLeavesInItsOwnTickMakesTheStableStiffnessFourTenthsHigher)
{
    Line         line;
    const double atOnce = largestStable(line);
    line.isHandedAtOnce = false;
    const double later  = largestStable(line);
    std::printf("  released arm at 1000 exchanges/s: stable up to %.0f N/m, a tick later up to %.0f\n", atOnce, later);
    EXPECT_NEAR(atOnce, 3.2 / 2.5e-3, 0.02 * 1280) << "2.5 ms of lag; 1 % of the search, 1 % of counts";
    EXPECT_NEAR(later, 3.2 / 3.5e-3, 0.02 * 914) << "3.5 ms";
}

TEST(FalconLag, APressedWallIsAtRestHalfASecondLaterOnEveryLine)
{
    const std::array arms{bareArm(), bareArm(0.1, 0.2)};
    for (const Line& line : lines())
        for (const SimulatedArmSettings& arm : arms)
            for (double damping : {0.0, 2.0}) { // [N s/m] of the hand: none at all, relaxed
                const Pressed wall = press(line, arm, damping, governorOf(arm, 1000));
                std::printf("  %-34s arm %.2f kg, %.1f N s/m, hand %.0f N s/m: cap %4.0f N/m, swing %5.3f mm, %.2f to "
                            "%.2f N\n",
                            line.name().c_str(), arm.mass, arm.damping, damping, wall.cap, wall.swing * 1e3, wall.least,
                            wall.most);
                EXPECT_GT(wall.least, 0.5 * std::min(kWart, wall.cap) * kDepth) << "or it rests on nothing";
                EXPECT_LT(wall.swing, 0.2e-3) << line.name();
                EXPECT_EQ(wall.fault, GovernorFault::none) << line.name();
            }
}

/// Returns what is left of the swing half a second after the same press without samples or lag [m].
double swingOfAContinuousWall(const SimulatedArmSettings& arm, double damping, double stiffness, double seconds)
{
    constexpr double kHand = 150, kStep = 1e-5; // [N/m], [s]
    const double     deep = kDepth * (1 + stiffness / kHand);
    double           y = 0, v = 0, low = 1, high = -1;
    for (double t = 0; t < seconds + kWait + 4; t += kStep) {
        const double wall = stiffness * std::max(0.0, -y), hand = kHand * (-deep * calmWay(t / seconds) - y);
        v += kStep * (wall + hand - damping * v) / arm.mass;
        y += kStep * v;
        if (t > seconds + kWait) low = std::min(low, y), high = std::max(high, y);
    }
    return high - low;
}

/// An undamped hand that pushes 14 mm in a quarter of a second makes any spring ring, for as long as the arm is damped.
/// What the loop adds to that is known: stiffness times lag is missing of the arm's damping, and no more.
TEST(FalconLag, AfterAQuickPressTheWallRingsAsOneWithTheDampingThatTheLagLeaves)
{
    for (const Line& line : lines()) {
        const Pressed wall  = press(line, bareArm(), 0, governorOf(bareArm(), 1000), 0.25);
        const double  felt  = std::min(kWart, wall.cap);
        const double  left  = bareArm().damping - felt * wall.lag;
        const double  ideal = swingOfAContinuousWall(bareArm(), bareArm().damping, felt, 0.25);
        const double  late  = swingOfAContinuousWall(bareArm(), left, felt, 0.25);
        std::printf("  %-34s %4.0f N/m: swing %5.3f mm; continuous wall with %.2f N s/m: %5.3f mm, with all: %5.3f\n",
                    line.name().c_str(), felt, wall.swing * 1e3, left, late * 1e3, ideal * 1e3);
        EXPECT_LT(wall.swing, 1.15 * late + 0.1e-3) << line.name() << ": two counts of the encoders";
    }
}

TEST(FalconLag, OneLateTickIsFeltForLessThanTwentyMillisecondsAndTheCapStays)
{
    for (double late : {5e-3, 10e-3, 20e-3, 50e-3}) {
        Rig           rig({}, bareArm(), {});
        SimulatedHand hand{.stiffness = 500, .damping = 5};
        Wall          wall{ForceGovernor(governorOf(bareArm(), 1000))};
        wall.stiffness = 866;
        rig.arm.holdBy(hand);
        const Tick tick = [&](const Reading& now) { return wall.tick(now); };
        rig.run(2, tick);
        hand.targetVelocity = {0, -10e-3, 0}; // to 5 mm, of which 1.8 are depth
        for (const double until = rig.time() + 0.5; rig.time() < until; hand.target.y -= 10e-6) {
            rig.arm.holdBy(hand);
            rig.run(1e-3, tick);
        }
        hand.targetVelocity = {};
        rig.arm.holdBy(hand);
        rig.run(1, tick);
        const double before = wall.out.force.y, cap = wall.governor.stiffnessCap();
        ASSERT_GT(before, 1);

        rig.delay(late);
        double     least = before, back = 0, lowestCap = cap, from = rig.time();
        const auto watch = [&](const Reading& now) {
            const auto force = wall.tick(now);
            least            = std::min(least, force.y);
            lowestCap        = std::min(lowestCap, wall.governor.stiffnessCap());
            if (std::abs(force.y - before) > 0.05 * before) back = now.time - rig.begun - from - late;
            return force;
        };
        rig.run(0.4, watch);

        std::printf("  a tick %2.0f ms late: %.2f N becomes %.2f, is back after %.1f ms; cap %.0f N/m\n", late * 1e3,
                    before, least, std::max(0.0, back) * 1e3, lowestCap);
        EXPECT_LT(least, 0.9 * before) << "the late tick's force is scaled";
        EXPECT_LT(back, 20e-3) << late;
        EXPECT_GT(lowestCap, 0.99 * cap) << late;
        EXPECT_EQ(wall.governor.fault(), GovernorFault::none);
    }
}

/// Figures of an arm that are not its own: the cap stays at the most that the device states, and the false damping is
/// credited, as it was to every device.
TEST(FalconLag, WithDampingThatTheArmDoesNotHaveTheSameWallSwings)
{
    GovernorSettings wrong = governorOf(bareArm(), 1000);
    wrong.ownDamping       = 32;
    for (double transfer : {500e-6, 1e-3})
        EXPECT_GT(press({.transfer = transfer}, bareArm(), 0, wrong).swing, 5e-3) << "or the tests above say nothing";
    EXPECT_GT(press({}, bareArm(0.1, 0.2), 0, wrong).swing, 5e-3);
}

} // namespace
} // namespace palp
