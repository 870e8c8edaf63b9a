#include "device/simulated_arm.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SimulatedArmSettings frictionless()
{
    SimulatedArmSettings settings;
    settings.encoderStep   = 0;
    settings.halfWorkspace = 1e3; // m: never in the way
    return settings;
}

TEST(SimulatedArm, FallsFromAForceAsTheExactSolutionSays)
{
    // m v' = F - b v from rest, F = 1 N, after 0.1 s; the delay of one tick is taken off.
    SimulatedArmSettings settings = frictionless();
    settings.delayTicks           = 0;
    SimulatedArm arm(settings);

    for (int n = 0; n < 100; ++n) static_cast<void>(arm.step({1, 0, 0}, 1e-3));

    const double rate = 3.2 / 0.46, v = (1 - std::exp(-rate * 0.1)) / 3.2,
                 x = (0.1 - (1 - std::exp(-rate * 0.1)) / rate) / 3.2;
    EXPECT_NEAR(arm.velocity().x, v, 1e-13) << "exact but for rounding";
    EXPECT_NEAR(arm.position().x, x, 1e-14) << "exact but for rounding";
}

TEST(SimulatedArm, SwingsOnTheHandsSpringAsTheExactSolutionSays)
{
    // Hand of 500 N/m without damping on an arm without damping: x = A cos(w t), whatever the tick.
    for (double period : {0.5e-3, 1e-3, 4e-3}) {
        SimulatedArmSettings settings = frictionless();
        settings.damping              = 0;
        SimulatedArm arm(settings, {0.01, 0, 0});
        arm.holdBy({.stiffness = 500});

        const int ticks = int(std::lround(2 / period));
        for (int n = 0; n < ticks; ++n) static_cast<void>(arm.step({}, period));

        EXPECT_NEAR(arm.position().x, 0.01 * std::cos(std::sqrt(500 / 0.46) * 2), 1e-11)
            << "rounding, period " << period;
    }
}

TEST(SimulatedArm, FollowsAHandThatMovesEvenly)
{
    SimulatedArm arm(frictionless());
    arm.holdBy({.stiffness = 500, .damping = 5, .targetVelocity = {0.02, 0, 0}});

    for (int n = 0; n < 4000; ++n) static_cast<void>(arm.step({}, 1e-3));

    EXPECT_NEAR(arm.velocity().x, 0.02, 1e-9) << "transients have died by exp(-35)";
    EXPECT_NEAR(arm.position().x, 0.02 * 4 - 3.2 * 0.02 / 500, 1e-9) << "behind by what drags the arm's own damper";
}

TEST(SimulatedArm, AForceActsOneTickLateAndIsHeld)
{
    for (int delay : {0, 1, 2}) {
        SimulatedArmSettings settings = frictionless();
        settings.delayTicks           = delay;
        SimulatedArm arm(settings);

        static_cast<void>(arm.step({1, 0, 0}, 1e-3));
        for (int n = 0; n < delay; ++n) {
            EXPECT_EQ(arm.velocity().x, 0) << "delay " << delay;
            static_cast<void>(arm.step({}, 1e-3));
        }
        EXPECT_NEAR(arm.velocity().x, 1e-3 / 0.46, 1e-5) << "1 N for 1 ms";
    }
}

TEST(SimulatedArm, TheEncoderRoundsAndTheVelocityIsOverItsWindow)
{
    SimulatedArm arm({}, {0.1e-3, -0.1e-3, 0});
    EXPECT_NEAR(arm.state().position.x, 2 * 48e-6, 1e-12);
    EXPECT_NEAR(arm.state().position.y, -2 * 48e-6, 1e-12);
    EXPECT_EQ(arm.state().velocity, glm::dvec3(0)) << "of one tick";

    SimulatedArmSettings settings;
    settings.damping = 0;
    SimulatedArm moving(settings, {}, {0.1, 0, 0});
    ArmState     armState;
    for (int n = 0; n < 200; ++n) {
        armState = moving.step({}, 1e-3);
        if (n < 15) continue;
        EXPECT_NEAR(armState.velocity.x, 0.1, 48e-6 / 15e-3 + 1e-12) << "one encoder step in the window";
    }
    EXPECT_NEAR(armState.time, 0.2, 1e-12);
}

TEST(SimulatedArm, FrictionHoldsAndStops)
{
    SimulatedArmSettings settings = frictionless();
    settings.friction             = 0.05;
    SimulatedArm held(settings), pushed(settings), sliding(settings, {}, {0.05, 0, 0});

    for (int n = 0; n < 1000; ++n) {
        static_cast<void>(held.step({0.049, 0, 0}, 1e-3));
        static_cast<void>(pushed.step({0.051, 0, 0}, 1e-3));
        static_cast<void>(sliding.step({}, 1e-3));
    }

    EXPECT_EQ(held.position().x, 0);
    EXPECT_GT(pushed.position().x, 0);
    EXPECT_EQ(sliding.velocity().x, 0);
    // m v' = -f - b v: stops after m/b ln(1 + b v/f), having gone m v/b - f t/b.
    const double t = 0.46 / 3.2 * std::log(1 + 3.2 * 0.05 / 0.05);
    EXPECT_NEAR(sliding.position().x, 0.46 * 0.05 / 3.2 - 0.05 * t / 3.2, 1e-6) << "to a piece of 125 us";
}

TEST(SimulatedArm, StopsAtTheEndOfItsWorkspaceAndSaysWhenItLeavesTheBox)
{
    SimulatedArm arm;
    for (int n = 0; n < 2000; ++n) static_cast<void>(arm.step({3, 0, 0}, 1e-3));

    EXPECT_EQ(arm.position().x, 0.05);
    EXPECT_EQ(arm.velocity().x, 0);
    EXPECT_FALSE(arm.state().inBox);
    EXPECT_TRUE(SimulatedArm().state().inBox);
}

TEST(SimulatedArm, WhatIsNotFiniteMovesNothing)
{
    SimulatedArm arm;
    for (double bad : {kNan, std::numeric_limits<double>::infinity()}) {
        static_cast<void>(arm.step({bad, 0, 0}, 1e-3));
        static_cast<void>(arm.step({1, 0, 0}, bad));
    }
    static_cast<void>(arm.step({1, 0, 0}, 0));
    static_cast<void>(arm.step({1, 0, 0}, -1));

    EXPECT_EQ(arm.position(), glm::dvec3(0));
    EXPECT_NEAR(arm.state().time, 2e-3, 1e-15) << "two ticks had a period";
}

TEST(SimulatedArm, RefusesSettingsOutOfRangeByName)
{
    const auto complaint = [](auto set) -> std::string {
        SimulatedArmSettings settings;
        set(settings);
        try {
            SimulatedArm arm(settings);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };

    EXPECT_NE(complaint([](auto& s) { s.mass = 0; }).find("mass"), std::string::npos);
    EXPECT_NE(complaint([](auto& s) { s.delayTicks = 8; }).find("delayTicks"), std::string::npos);
    EXPECT_NE(complaint([](auto& s) { s.encoderStep = kNan; }).find("encoderStep"), std::string::npos);
}

// The largest stiffness of a spring f = -K x - B (x - x')/T on the released arm at which a deflection still dies.
double stiffnessLimit(double period, int delay, double damping, double low, double high)
{
    SimulatedArmSettings settings = frictionless();
    settings.mass                 = 0.459;
    settings.delayTicks           = delay;
    const auto dies               = [&](double stiffness) {
        SimulatedArm arm(settings, {1e-3, 0, 0});
        double       last = 1e-3, early = 0, late = 0;
        const int    second = int(std::lround(1 / period));
        for (int n = 0; n < 8 * second; ++n) {
            const double x = arm.position().x;
            static_cast<void>(arm.step({-stiffness * x - damping * (x - last) / period, 0, 0}, period));
            last = x;
            if (n >= second && n < 2 * second) early = std::max(early, std::abs(x));
            if (n >= 7 * second) late = worse(late, x);
        }
        return late < early;
    };
    EXPECT_TRUE(dies(low)) << low << " N/m";
    EXPECT_FALSE(dies(high)) << high << " N/m";
    for (int n = 0; n < 8; ++n) (dies(std::sqrt(low * high)) ? low : high) = std::sqrt(low * high);
    return std::sqrt(low * high);
}

TEST(SimulatedArm, StabilityLimitsAreThoseOfTheDiscreteEigenvalues)
{
    // Eigenvalues of the sampled loop for 0.459 kg and 3.2 N s/m, in N/m: radii of powers of its exact matrix.
    struct Row {
        double period;                 // [s]
        double none, one, two, damped; // delays of 0, 1, 2 ticks; delay 1 with B = 5 N s/m
    };
    double worst = 0;
    for (const Row& row : {Row{0.5e-3, 12807, 4271, 2564, 10878}, Row{1e-3, 6407, 2137, 1284, 5411},
                           Row{2e-3, 3207, 1071, 644, 2678}, Row{4e-3, 1607, 537, 324, 1312}}) {
        const auto check = [&](double expected, int delay, double damping) {
            const double found = stiffnessLimit(row.period, delay, damping, expected / 1.5, expected * 1.5);
            worst              = std::max(worst, std::abs(found / expected - 1));
            std::printf("  T %.1f ms, delay %d, B %.0f: %5.0f N/m (table %.0f)\n", row.period * 1e3, delay, damping,
                        found, expected);
            EXPECT_NEAR(found, expected, 0.01 * expected)
                << "T = " << row.period << " s, delay " << delay << ", B = " << damping
                << ": 1 %, three times the last halving of the search";
        };
        check(row.none, 0, 0);
        check(row.one, 1, 0);
        check(row.two, 2, 0);
        check(row.damped, 1, 5);
    }
    std::printf("  largest difference to the table: %.2f %%\n", 100 * worst);
}

} // namespace
} // namespace palp
