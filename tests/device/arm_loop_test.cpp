// Tests of the whole loop in virtual time: force law, tank, governor, arm and hand. The object is flat, z = 0 with the
// outside above; only its stiffness varies.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/simulated_arm.h"
#include "engine/force/energy_tank.h"
#include "engine/force/force_law.h"
#include "engine/force/governor.h"
#include "engine/force/lateral_lean.h"
#include "tests/support/sanitized.h"

namespace palp {
namespace {

constexpr double kDt = 1e-3; // [s]

/// Stiffness at a place [m] -> [N/m].
using Law = std::function<double(const glm::dvec3&)>;

/// Contact of 3000 N/m on a plate of 1/250 m/N; under a wart of contrast 100, 4 mm wide, the plate's compliance falls
/// to less than a third at R = 4 mm; here to a tenth, so that the cap binds.
double wart(const glm::dvec3& p)
{
    const double r2         = (p.x * p.x + p.y * p.y) / (2 * 4e-3 * 4e-3);
    const double compliance = std::exp(std::log(1.0 / 250) - std::log(10.0) * std::exp(-r2));
    return feltStiffness(ForceLaw::series, 3000, compliance);
}

double step(const glm::dvec3& p)
{
    return p.x < 0 ? 100 : 1000;
}

struct Loop {
    SimulatedArm   arm;
    EnergyTank     tank;
    ForceGovernor  governor;
    Law            law;
    LateralLean    lean{};
    bool           capped = true, tanked = true, governed = true, leaning = true;
    GovernorInput  in{};
    GovernorOutput out{};
    double         leastEnergy = 0;         // [J]
    glm::dvec3     lastProxy{}, lastHand{}; // [m] of the tick before
    bool           inContact = false;       // then

    Loop(const Law& stiffness, const SimulatedArmSettings& settings, const glm::dvec3& start)
        : arm(settings, start), law(stiffness)
    {
        in.homed = true;
        in.dt    = kDt;
    }

    /// The slope of what is rendered.
    [[nodiscard]] StiffnessSlope slopeAt(const glm::dvec3& place) const
    {
        constexpr double kWay = 20e-6; // [m]
        const auto       at   = [&](double x, double y) {
            const double stiffness = law(place + glm::dvec3(x, y, 0));
            return std::log(capped ? std::min(stiffness, governor.stiffnessCap()) : stiffness);
        };
        return {{(at(kWay, 0) - at(-kWay, 0)) / (2 * kWay), (at(0, kWay) - at(0, -kWay)) / (2 * kWay), 0}, 0};
    }

    void tick()
    {
        const ArmState state = arm.state();
        touch(state, law(state.position), state.velocity, slopeAt(state.position));
    }

    /// One tick with a stiffness and a velocity of the caller's choice. Nothing rubs: the proxy is above the hand, but
    /// for the lean.
    void touch(const ArmState& armState, double stiffness, const glm::dvec3& velocity, const StiffnessSlope& slope = {})
    {
        const double     deep   = std::max(0.0, -armState.position.z);
        const double     wanted = capped ? std::min(stiffness, governor.stiffnessCap()) : stiffness;
        const glm::dvec3 foot{armState.position.x, armState.position.y, 0}, proxy = foot + lean.way();
        const glm::dvec3 pull  = lean.way() + glm::dvec3(0, 0, deep);
        const double     depth = glm::length(pull), sliding = std::hypot(velocity.x, velocity.y);
        EnergyTankOutput spring{wanted, 0, wanted * depth * depth / 2};
        const double     drag = inContact && deep > 0 ? -glm::dot(lean.way(), proxy - lastProxy) : 0;
        if (tanked) spring = tank.step({wanted, depth, velocity.z, sliding, kDt, drag});

        in.force          = spring.stiffness * pull;
        in.position       = armState.position;
        in.velocity       = velocity;
        in.inBox          = armState.inBox;
        in.admittedEnergy = spring.used;
        in.storedEnergy   = spring.stored;
        inContact         = deep > 0;
        if (inContact && leaning)
            lean.step(slope, pull, glm::length(armState.position - lastHand));
        else
            lean.end();
        lastProxy = proxy;
        lastHand  = armState.position;
        if (governed) out = governor.step(in);
        static_cast<void>(arm.step(governed ? out.force : in.force, kDt));
        leastEnergy = std::min(leastEnergy, out.energy);
    }

    /// Held above the surface until the force is on.
    void engage(const glm::dvec3& above)
    {
        arm.holdBy({.stiffness = 500, .damping = 20, .target = above});
        for (int n = 0; n < 1600; ++n) tick();
        if (governed) {
            ASSERT_EQ(out.gain, 1);
        }
    }
};

struct Swing {
    double low = 1, high = -1; // [m]

    void   add(double z) { low = std::min(low, z), high = std::max(high, z); }
    double half() const { return (high - low) / 2; } // [m]
};

TEST(ArmLoop, ReleasedIntoAStiffWartAtTheCapItSettles)
{
    ASSERT_GT(wart({}), 1000) << "the cap must bind";
    std::printf("  hand N/m  friction N | swing um  depth mm  least E mJ\n");
    for (double hand : {50.0, 150.0, 500.0})
        for (double friction : {0.0, 0.05}) {
            SimulatedArmSettings settings;
            settings.friction = friction;
            Loop loop(wart, settings, {1e-3, 0, 5e-3});
            loop.engage({1e-3, 0, 5e-3});

            // Let go: an undamped hand pulls it down from 5 mm above, with 2 N at the surface.
            loop.arm.holdBy({.stiffness = hand, .target = {1e-3, 0, -2 / hand}});
            // What the arm, the hand's spring and the contact hold must never exceed what it was let go with.
            Swing        swing;
            const double down   = -2 / hand; // [m]
            const auto   energy = [&] {      // [J]
                const double z = loop.arm.position().z, v = glm::length(loop.arm.velocity());
                return 0.46 * v * v / 2 + hand * (z - down) * (z - down) / 2 + loop.in.storedEnergy;
            };
            const double letGo = energy();
            double       most  = 0;
            for (int n = 0; n < 6000; ++n) {
                loop.tick();
                most = std::max(most, energy());
                if (n >= 5000) swing.add(loop.arm.position().z);
            }

            std::printf("  %8.0f  %10.2f | %8.1f  %8.3f  %10.3f\n", hand, friction, swing.half() * 2e6,
                        -swing.low * 1e3, loop.leastEnergy * 1e3);
            EXPECT_EQ(loop.out.fault, GovernorFault::none);
            EXPECT_LE(2 * swing.half(), 2 * 48e-6) << "two encoder steps, hand " << hand << ", friction " << friction;
            EXPECT_LT(swing.high, 0) << "in contact";
            EXPECT_LE(most, letGo + loop.governor.settings().energyTolerance) << "where from?";
            EXPECT_GE(loop.leastEnergy, -loop.governor.settings().energyTolerance);
        }
}

TEST(ArmLoop, SlidToAndFroOverAWartItsEnergyStaysAboveTheTolerance)
{
    Loop loop(wart, {}, {-15e-3, 0, 5e-3});
    loop.engage({-15e-3, 0, 5e-3});

    for (int n = 0; n < 30000; ++n) { // 15 mm each way with 1 Hz, 10 mm below the surface at 150 N/m
        const double w = 2 * std::numbers::pi, t = n * kDt;
        loop.arm.holdBy({.stiffness      = 150,
                         .target         = {-15e-3 * std::cos(w * t), 0, -10e-3},
                         .targetVelocity = {15e-3 * w * std::sin(w * t), 0, 0}});
        loop.tick();
    }

    std::printf("  least E %.3f mJ\n", loop.leastEnergy * 1e3);
    EXPECT_EQ(loop.out.fault, GovernorFault::none);
    EXPECT_GE(loop.leastEnergy, -loop.governor.settings().energyTolerance);
}

/// The work that the device does on a hand that all but prescribes the way: five times down 5 mm at 0.05 m/s from
/// above, across an edge of 6 mm from 250 to 800 N/m, up, and back above the surface. The most of one cycle [J].
double workPerCycle(Loop loop, double depth, double speed)
{
    loop.law = [](const glm::dvec3& p) { return 250 + 550 * (1 + std::tanh(p.x / 3e-3)) / 2; };
    loop.engage({-20e-3, 0, 2e-3});
    const glm::dvec3 corners[] = {
        {-20e-3, 0, 2e-3}, {-20e-3, 0, -depth}, {20e-3, 0, -depth}, {20e-3, 0, 2e-3}, {-20e-3, 0, 2e-3}};
    double most = -1;
    for (int cycle = 0; cycle < 5; ++cycle) {
        double work = 0;
        for (int side = 0; side < 4; ++side) {
            const glm::dvec3 way   = corners[side + 1] - corners[side];
            const double     pace  = side % 2 == 0 ? 0.05 : speed;
            const int        ticks = int(std::lround(glm::length(way) / pace / kDt));
            loop.arm.holdBy({1e5, 200, corners[side], way / (ticks * kDt)});
            for (int n = 0; n < ticks; ++n) {
                const glm::dvec3 acts = loop.governed ? loop.out.force : loop.in.force, from = loop.arm.position();
                loop.tick();
                work += glm::dot(acts, loop.arm.position() - from); // of the tick before: one tick late
            }
        }
        most = std::max(most, work);
    }
    EXPECT_EQ(loop.out.fault, GovernorFault::none);
    return most;
}

TEST(ArmLoop, PressSlideReleaseGainsLittleThroughTheWholeLoop)
{
    std::printf("  depth  speed | plain mJ  whole mJ\n");
    for (double depth : {2e-3, 3e-3, 5e-3})
        for (double speed : {0.05, 0.2}) {
            Loop whole(wart, {}, {-20e-3, 0, 2e-3}), bare = whole;
            bare.tanked = bare.governed = bare.leaning = false;
            const double plain = workPerCycle(bare, depth, speed), work = workPerCycle(whole, depth, speed);

            std::printf("  %2.0f mm  %5.2f | %8.2f  %8.2f\n", depth * 1e3, speed, plain * 1e3, work * 1e3);
            // Beside what is stored, a sampled spring gives K (T/2 + delay) v^2 both ways: 1.5 ms of it.
            const double stored = depth * depth * 550 / 2, sampled = (250 + 800) * 1.5e-3 * 0.05 * depth;
            EXPECT_NEAR(plain, stored + sampled, 0.1 * stored) << "the test must bite";
            EXPECT_LE(work, 0.02e-3 + sampled) << "sliding gives nothing";
        }
}

/// An undamped hand of 150 N/m that reaches 12 mm deep, across a step from 100 to 1000 N/m.
constexpr double    kReach       = 12e-3;                                       // [m]
constexpr double    kQuasiStatic = 150 * kReach * (1.0 / 250 - 1.0 / 1150) / 2; // [m] 2.8 mm about the middle
const SimulatedHand kReaching{.stiffness = 150, .target = {0, 0, -kReach}};

/// The depth's swing when the step is crossed once each way, from rest to rest: the hand has no damping and overshoots.
double crossedOnce()
{
    Loop loop(step, {}, {0, 0, 5e-3});
    loop.tanked = loop.governed = false;
    loop.arm.holdBy(kReaching);
    Swing swing;
    for (int n = 0; n < 15000; ++n) {
        loop.touch(loop.arm.state(), n / 5000 == 1 ? 100 : 1000, loop.arm.state().velocity);
        if (n >= 5000) swing.add(loop.arm.position().z);
    }
    return swing.half();
}

enum class Sideways {
    forced, // the grip itself goes 3 mm each way
    held    // the hand does, and holds the grip with its 150 N/m
};

/// The depth's swing in the end, while the hand is shaken sideways. The servo learns `late` ms late where it is.
double shaken(Loop& loop, double frequency, int late, Sideways sideways)
{
    std::array<double, 64> past{};
    const double           w = 2 * std::numbers::pi * frequency; // [1/s]
    loop.engage({0, 0, 5e-3});
    Swing swing;
    for (int n = 0; n < 8000; ++n) {
        const double  x = 3e-3 * std::sin(w * n * kDt), v = 3e-3 * w * std::cos(w * n * kDt);
        SimulatedHand hand     = kReaching;
        ArmState      armState = loop.arm.state();
        if (sideways == Sideways::forced) {
            armState.position.x = x;
            armState.velocity.x = v;
        } else {
            hand.target.x         = x;
            hand.targetVelocity.x = v;
        }
        loop.arm.holdBy(hand);
        past[std::size_t(n) % past.size()] = armState.position.x;
        const double known                 = past[std::size_t(std::max(0, n - late)) % past.size()];
        loop.touch(armState, step({known, 0, 0}), armState.velocity);
        if (n >= 4000) swing.add(loop.arm.position().z);
    }
    return swing.half();
}

TEST(ArmLoop, ShakingAcrossAStepDoesNotPump)
{
    double plain = 0, tank = 0, whole = 0, forced = 0;
    for (double frequency : {3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 14.0, 18.0})
        for (int late : {0, 17, 33}) {
            Loop all(step, {}, {0, 0, 5e-3}), bare = all, again = all, tankOnly = all;
            bare.tanked = bare.governed = tankOnly.governed = false;
            plain  = std::max(plain, shaken(bare, frequency, late, Sideways::forced));
            tank   = std::max(tank, shaken(tankOnly, frequency, late, Sideways::forced));
            whole  = std::max(whole, shaken(all, frequency, late, Sideways::held));
            forced = std::max(forced, shaken(again, frequency, late, Sideways::forced));
        }
    const double once = crossedOnce();

    std::printf("  swing of the depth, mm: quasi-static %.2f, crossed once %.2f; shaken: plain %.1f, tank %.2f, "
                "tank and governor %.2f, forced %.2f\n",
                kQuasiStatic * 1e3, once * 1e3, plain * 1e3, tank * 1e3, whole * 1e3, forced * 1e3);
    EXPECT_GT(plain, 4 * kQuasiStatic) << "the test must bite";
    EXPECT_LE(tank, kQuasiStatic);
    EXPECT_LE(whole, once) << "no more than crossing it once: shaking adds nothing";
    EXPECT_LE(forced, once) << "the same for whoever forces the grip sideways";
}

/// A wall of 3000 N/m, beyond the released arm's limit of 2137, under an undamped hand: the depth's swing in the end
/// [m].
double onTooStiffAWall(Loop loop)
{
    loop.tanked = false;
    loop.engage({0, 0, 5e-3});
    loop.arm.holdBy({.stiffness = 150, .target = {0, 0, -10e-3}});
    Swing swing;
    for (int n = 0; n < 10000; ++n) {
        loop.tick();
        if (n >= 9000) swing.add(loop.arm.position().z);
    }
    EXPECT_EQ(loop.out.fault, GovernorFault::none);
    return swing.half();
}

TEST(ArmLoop, WithoutCapAndControllerTheArmShakes)
{
    const auto       wall = [](const glm::dvec3&) { return 3000.0; };
    GovernorSettings settings;
    settings.passivityDamping = 0;
    Loop whole(wall, {}, {0, 0, 5e-3}), controlled = whole, neither = whole;
    controlled.capped = neither.capped = false;
    neither.governor                   = ForceGovernor(settings);

    const double calm = onTooStiffAWall(whole), held = onTooStiffAWall(controlled), wild = onTooStiffAWall(neither);

    std::printf("  swing on a wall of 3000 N/m, um: cap %.0f, passivity controller alone %.0f, neither %.0f\n",
                calm * 1e6, held * 1e6, wild * 1e6);
    EXPECT_LE(calm, 48e-6) << "an encoder step each way";
    EXPECT_GT(wild, 10 * calm) << "the test must bite";
    EXPECT_LT(held, wild);
}

/// Ticks of the long run; under sanitizers, which are ten times as slow, fewer.
constexpr long kLongRun = kSanitized ? 1'000'000 : 10'000'000;

TEST(ArmLoop, RunsForTenMillionTicksWithoutAFaultOrANonFiniteNumber)
{
    Loop loop(wart, {}, {0, 0, 5e-3});
    loop.engage({0, 0, 5e-3});
    std::mt19937                           random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    glm::dvec3                             target{0, 0, 5e-3};
    double                                 deepest = 0, fastest = 0, strongest = 0;
    long                                   damped = 0;
    const long                             ticks  = kLongRun;
    const auto                             start  = std::chrono::steady_clock::now();
    for (long n = 0; n < ticks;) {
        // To a place up to 20 mm aside and 12 mm deep or above, at up to 0.3 m/s, by hands from slack to firm.
        const glm::dvec3 goal  = {(unit(random) - 0.5) * 40e-3, (unit(random) - 0.5) * 40e-3,
                                  (unit(random) - 0.6) * 20e-3};
        const double     speed = 0.02 + 0.28 * unit(random), stiffness = 50 + 450 * unit(random);
        const double     damping = 3 * unit(random);
        const int        count   = 1 + int(glm::length(goal - target) / speed / kDt);
        const glm::dvec3 rate    = (goal - target) / (count * kDt);
        loop.arm.holdBy({stiffness, damping, target, rate});
        for (int m = 0; m < count && n < ticks; ++m, ++n) {
            loop.tick();
            const glm::dvec3 f = loop.out.force;
            ASSERT_TRUE(std::isfinite(f.x + f.y + f.z + loop.out.energy + loop.tank.energy() + loop.tank.stiffness()));
            ASSERT_EQ(loop.out.fault, GovernorFault::none) << name(loop.out.fault) << " in tick " << n;
            deepest   = std::max(deepest, -loop.arm.position().z);
            fastest   = std::max(fastest, glm::length(loop.arm.velocity()));
            strongest = std::max(strongest, glm::length(f));
            damped += loop.out.did(GovernorAction::damped);
        }
        target = goal;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("  %ld ticks in %.1f s: deepest %.1f mm, fastest %.2f m/s, strongest %.2f N, least E %.3f mJ, damped "
                "%.2f %% of ticks\n",
                ticks, seconds, deepest * 1e3, fastest, strongest, loop.leastEnergy * 1e3,
                100.0 * double(damped) / double(ticks));
    EXPECT_EQ(loop.out.gain, 1) << "engaged to the end";
    EXPECT_GT(strongest, 2) << "or the test says nothing";
    EXPECT_GE(loop.leastEnergy, -loop.governor.settings().energyTolerance);
}

TEST(ArmLoop, TheSameRunGivesTheSameBits)
{
    const auto run = [] {
        Loop loop(wart, {}, {1e-3, 0, 5e-3});
        loop.engage({1e-3, 0, 5e-3});
        loop.arm.holdBy({.stiffness = 150, .target = {8e-3, 0, -10e-3}});
        for (int n = 0; n < 3000; ++n) loop.tick();
        return std::pair{loop.arm.position(), loop.out.energy};
    };
    EXPECT_EQ(run(), run());
}

} // namespace
} // namespace palp
