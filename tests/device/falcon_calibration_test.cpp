// Tests of weighing a known mass on an emulated Falcon whose motors differ from the driver's setting.
#include "device/falcon/falcon_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "device/falcon/falcon_hold.h"
#include "device/simulated_arm.h"
#include "engine/core/contract.h"
#include "tests/device/falcon_bench.h"

namespace palp {
namespace {

constexpr double kArm = 0.21; // [kg] of it weighs on the grip

/// A user with a mass in reach, and motors of `truth` [counts/(N m)].
struct Weighing {
    double            hanging = 0; // [kg]
    double            touch   = 0; // [N] by which somebody pushes it up and down, each 7 s
    double            clock   = 0; // [s]
    SimulatedArm      arm;
    FalconBench       bench;
    ForceGovernor     governor;
    FalconCalibration calibration;

    Weighing(double truth, double friction, const FalconCalibrationSettings& settings = {}, double weighs = kArm)
        : arm(like(friction), {0, 0.004, -0.006}),
          bench(motors(truth),
                [this, weighs](const glm::dvec3& force, double dt) {
                    // Its inertia is left out: means do not see it.
                    clock += dt;
                    const double push = touch * std::sin(0.9 * clock);
                    arm.step(force + glm::dvec3(0, push - (weighs + hanging) * 9.81, 0), dt);
                    return arm.position();
                }),
          calibration(settings)
    {
    }

    static SimulatedArmSettings like(double friction)
    {
        SimulatedArmSettings settings;
        settings.friction    = friction;
        settings.encoderStep = 0;
        settings.delayTicks  = 0;
        return settings;
    }

    static Ft232EmulatorSettings motors(double truth)
    {
        Ft232EmulatorSettings settings  = runningFalcon();
        settings.falcon.countsPerTorque = truth;
        return settings;
    }

    void tick(double& gain)
    {
        GovernorInput in;
        in.force = calibration.step(bench.state, bench.force, gain, 1e-3);
        bench.device->useCounts(calibration.countsInUse());
        in.position = bench.state.position;
        in.velocity = bench.state.velocity;
        in.homed    = bench.state.homed;
        in.inBox    = bench.state.inBox;
        in.dt       = 1e-3;
        gain        = governor.step(in).gain;
        bench.force = governor.force();
        bench.tick();
    }

    /// The user holds the grip until force comes on, then hangs `mass` [kg] when asked to.
    void run(double mass)
    {
        double gain = 0, asked = -1; // s
        bench.tick();
        for (const double until = bench.now + 90; bench.now < until;) {
            arm.holdBy(gain < 1 ? SimulatedHand{.stiffness = 500, .damping = 20, .target = {0, 0.004, -0.006}}
                                : SimulatedHand{});
            tick(gain);
            const auto stage = calibration.stage();
            if (stage == FalconCalibrationStage::done || stage == FalconCalibrationStage::failed) return;
            if (stage != FalconCalibrationStage::hang) continue;
            if (asked < 0) asked = bench.now;
            hanging = mass;
            if (bench.now > asked + 0.2) calibration.hung();
        }
    }
};

TEST(FalconCalibration, FindsTheCountsThatHoldTheMass)
{
    // 10 000 is libnifalcon's, for which 4200 is 2.38 times too few; and the other way round.
    struct Case {
        double truth, friction, begin, mass;
    };
    for (const auto& [truth, friction, begin, mass] :
         {Case{2500, 0.08, 4200, 0.2}, Case{4200, 0, 4200, 0.2}, Case{5500, 0.08, 4200, 0.2},
          Case{10000, 0.05, 4200, 0.2}, Case{10000, 0.05, 4200, 0.05}, Case{4200, 0.05, 10000, 0.2},
          Case{4200, 0.05, 10000, 0.1}, Case{5000, 0.05, 2100, 0.2}}) {
        Weighing weighing(truth, friction, {.mass = mass, .countsPerTorque = begin});

        weighing.run(mass);

        ASSERT_EQ(weighing.calibration.stage(), FalconCalibrationStage::done) << weighing.calibration.failure();
        const double found = weighing.calibration.countsPerTorque().value();
        std::printf("  motors of %.0f, begun with %.0f, friction %.2f N: weighed with %.0f, found %.1f, arm %.4f kg\n",
                    truth, begin, friction, weighing.calibration.countsInUse(), found,
                    weighing.calibration.armMass().value());
        const double share = 0.005 * 0.2 / mass; // 0.01 N of its weight: two counts of the motors, 4 mN each
        EXPECT_NEAR(found, truth, share * truth) << mass << " kg";
        EXPECT_NEAR(weighing.calibration.armMass().value(), kArm, 2 * share * kArm) << "twice that";
        EXPECT_NEAR(weighing.calibration.countsInUse(), truth, 0.1 * truth) << "so that the mass is held";
    }
}

TEST(FalconCalibration, WithoutTheMassItFails)
{
    Weighing weighing(4200, 0.05);

    weighing.run(0);

    EXPECT_EQ(weighing.calibration.stage(), FalconCalibrationStage::failed);
    EXPECT_NE(std::string(weighing.calibration.failure()).find("no mass"), std::string::npos);
    EXPECT_FALSE(weighing.calibration.countsPerTorque());
}

/// Such a number would be refused wherever it is used, so it is no result: the mass is another one than was named.
TEST(FalconCalibration, CountsOutOfTheBoundsAreNoResult)
{
    struct Case {
        double truth, named; // [counts/(N m)], [kg]; 0.2 hang: 16 800 and 1680 counts
    };
    for (const auto& [truth, named] : {Case{4200, 0.05}, Case{2100, 0.25}}) {
        Weighing weighing(truth, 0.05, {.mass = named});

        weighing.run(0.2);

        EXPECT_EQ(weighing.calibration.stage(), FalconCalibrationStage::failed) << named;
        EXPECT_NE(std::string(weighing.calibration.failure()).find("check the mass"), std::string::npos) << named;
        EXPECT_FALSE(weighing.calibration.countsPerTorque()) << named;
    }
}

/// Twice as heavy as any that is known: the counts seem to be too few, and the weighing finds that they were not.
TEST(FalconCalibration, AnArmOfAnotherWeightIsWeighed)
{
    for (const double arm : {0.1, 0.35}) { // [kg]
        Weighing weighing(4200, 0.05, {.mass = 0.1}, arm);

        weighing.run(0.1);

        ASSERT_EQ(weighing.calibration.stage(), FalconCalibrationStage::done) << weighing.calibration.failure();
        EXPECT_NEAR(weighing.calibration.countsPerTorque().value(), 4200, 0.02 * 4200) << arm;
        EXPECT_NEAR(weighing.calibration.armMass().value(), arm, 0.02 * arm);
    }
    Weighing heavy(4200, 0.05, {.mass = 0.1}, 0.45);
    heavy.run(0.1);
    EXPECT_EQ(heavy.calibration.stage(), FalconCalibrationStage::failed);
    EXPECT_NE(std::string(heavy.calibration.failure()).find("400 g"), std::string::npos) << heavy.calibration.failure();
}

/// The range that --mass promises: the heaviest mass beside the lightest and the heaviest arm, for motors from the
/// strongest to the weakest; 4530 counts with 0.21 kg are taken for 4200.
TEST(FalconCalibration, TheHeaviestMassIsHeldBesideEveryLikelyArm)
{
    struct Case {
        double truth, arm; // [counts/(N m)], [kg]
    };
    for (const auto& [truth, weighs] : {Case{2000, 0.18}, Case{5280, 0.18}, Case{4530, 0.21}, Case{10000, 0.18},
                                        Case{10000, 0.25}, Case{4200, 0.39}}) {
        Weighing weighing(truth, 0.05, {.mass = FalconCalibration::kMostMass}, weighs);

        weighing.run(FalconCalibration::kMostMass);

        ASSERT_EQ(weighing.calibration.stage(), FalconCalibrationStage::done)
            << truth << " counts, " << weighs << " kg: " << weighing.calibration.failure();
        EXPECT_NEAR(weighing.calibration.countsPerTorque().value(), truth, 0.004 * truth)
            << weighs << " kg; 0.5 % of 0.2 kg, as above";
    }
    Weighing light(4200, 0.05, {.mass = FalconCalibration::kMostMass}, 0.1);
    light.run(FalconCalibration::kMostMass);
    EXPECT_NE(std::string(light.calibration.failure()).find("lighter"), std::string::npos) << "2.5 times the arm";
}

TEST(FalconCalibration, TouchedItFails)
{
    Weighing weighing(4200, 0.05);
    weighing.touch = 0.3;

    weighing.run(0.2);

    EXPECT_EQ(weighing.calibration.stage(), FalconCalibrationStage::failed);
    EXPECT_NE(std::string(weighing.calibration.failure()).find("let go"), std::string::npos);
}

TEST(FalconCalibration, AMassBeyondTheGovernorFails)
{
    Weighing weighing(8000, 0.05); // it is held with 10 % of the right counts, so that 7 N would have to be commanded

    weighing.run(0.5);

    EXPECT_EQ(weighing.calibration.stage(), FalconCalibrationStage::failed);
    EXPECT_NE(std::string(weighing.calibration.failure()).find("lighter"), std::string::npos);
}

TEST(FalconCalibration, AWeightAtTheGovernorsLimitFails)
{
    // 6.02 N of weight with the right counts; the governor's 6 and friction hold it.
    Weighing weighing(4200, 0.2, {.mass = 0.25});

    weighing.run(0.404);

    EXPECT_EQ(weighing.calibration.stage(), FalconCalibrationStage::failed);
}

TEST(FalconCalibration, RefusesSettingsOutOfRange)
{
    EXPECT_THROW(FalconCalibration({.mass = 0}), Error);
    EXPECT_THROW(FalconCalibration({.mass = 0.26}), Error);
    EXPECT_THROW(FalconCalibration({.mass = 0.2, .up = {0, 2, 0}}), Error);
}

/// Arm and mass hang on the motors; each silence ends in a drop of a few millimetres at most.
TEST(FalconHold, IsFoundByTheFallOfTheGrip)
{
    for (const double truth : {10e-3, 20e-3, 60e-3, 100e-3, 300e-3}) {
        SimulatedArm arm(Weighing::like(0.05), {0, 0.004, -0.006});
        auto         settings    = runningFalcon();
        settings.falcon.holdTime = truth;
        double        lowest = 0, weight = 0; // [m], [N], which the user puts on it gradually
        FalconBench   bench(settings, [&](const glm::dvec3& force, double dt) {
            arm.step(force - glm::dvec3(0, weight, 0), dt);
            return arm.position();
        });
        ForceGovernor governor;
        FalconHold    hold({0, 0, 0});
        bench.tick();
        for (double gain = 0, time = 0; !hold.isDone() && time < 120; time += 1e-3) {
            GovernorInput in;
            if (gain >= 1) weight = std::min(4.0, weight + 4e-3);
            arm.holdBy(gain < 1 ? SimulatedHand{.stiffness = 500, .damping = 20, .target = {0, 0.004, -0.006}}
                                : SimulatedHand{});
            in.force           = hold.step(*bench.device, bench.state, weight < 4 ? std::min(gain, 0.99) : gain, 1e-3);
            in.position        = bench.state.position;
            in.velocity        = bench.state.velocity;
            in.homed           = bench.state.homed;
            in.inBox           = bench.state.inBox;
            in.dt              = 1e-3;
            in.missedExchanges = bench.state.missed;
            gain               = governor.step(in).gain;
            bench.force        = governor.force();
            bench.tick();
            if (weight >= 4 && time > 8) lowest = std::min(lowest, arm.position().y - 0.004);
        }
        ASSERT_TRUE(hold.hold().has_value()) << truth;
        std::printf("  hold %.1f ms, found %.2f ms, dropped by %.1f mm\n", 1e3 * truth, 1e3 * *hold.hold(),
                    -1e3 * lowest);
        EXPECT_NEAR(*hold.hold(), truth, std::max(1e-3, 0.01 * truth)) << "an exchange, or a hundredth of a long hold";
        EXPECT_GT(lowest, -10e-3) << "the centimetre that device/README.md promises";
    }
}

} // namespace
} // namespace palp
