#include "engine/force/energy_tank.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <utility>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDt  = 1e-3; // [s]

static_assert(std::is_trivially_copyable_v<EnergyTank>, "it owns nothing, so it cannot allocate");
static_assert(noexcept(std::declval<EnergyTank&>().step({})));

EnergyTankInput at(double stiffness, double depth, double normalSpeed = 0, double tangentialSpeed = 0)
{
    return {stiffness, depth, normalSpeed, tangentialSpeed, kDt};
}

TEST(EnergyTank, StiffnessIsFreeOutsideAndWhereItFalls)
{
    EnergyTank tank;
    EXPECT_EQ(tank.step(at(1000, 0)).stiffness, 1000);
    EXPECT_EQ(tank.step(at(400, 5e-3)).stiffness, 400);
    EXPECT_EQ(tank.step(at(900, -1e-3)).stiffness, 900);
}

TEST(EnergyTank, AFallOfStiffnessFillsIt)
{
    EnergyTank tank;
    static_cast<void>(tank.step(at(1000, 0)));

    static_cast<void>(tank.step(at(900, 2e-3)));

    // 2 mm squared times 100 N/m over 2 is 0.2 mJ; 1 mW for two ticks is 2 uJ; 0.2 mJ were there.
    EXPECT_NEAR(tank.energy(), 0.2e-3 + 2e-6 + 0.2e-3, 1e-15);
}

TEST(EnergyTank, ARiseIsPaidFromItAndWaitsWhenItIsEmpty)
{
    EnergyTank tank;
    static_cast<void>(tank.step(at(100, 0)));

    const EnergyTankOutput out = tank.step(at(1000, 5e-3));

    // 0.2 mJ and 2 uJ in a spring 5 mm deep are 2 * 0.202e-3 / 25e-6 = 16.16 N/m.
    EXPECT_NEAR(out.stiffness, 116.16, 1e-9);
    EXPECT_NEAR(out.used, 0.202e-3, 1e-15);
    EXPECT_NEAR(out.stored, 116.16 * 25e-6 / 2, 1e-15);
    EXPECT_EQ(out.brake, 0) << "nothing slides";
    EXPECT_EQ(tank.energy(), 0);
    EXPECT_NEAR(tank.step(at(1000, 5e-3)).stiffness, 116.16 + 2 * 1e-6 / 25e-6, 1e-9) << "1 mW goes on";
}

TEST(EnergyTank, TheHandPaysThroughTheBrakeFirst)
{
    EnergyTankSettings settings;
    settings.start = 0;
    settings.power = 0;
    EnergyTank tank(settings);
    static_cast<void>(tank.step(at(500, 0)));

    const EnergyTankOutput out = tank.step(at(1000, 4e-3, 0, 0.1));

    // mu K d = 0.3 * 500 * 4e-3 = 0.6 N over 0.1 mm are 60 uJ; the tank has 1 N s/m * 0.01 * 1 ms = 10 uJ.
    EXPECT_NEAR(out.brake, 0.6, 1e-12);
    EXPECT_NEAR(out.used, 10e-6, 1e-15);
    EXPECT_NEAR(out.stiffness, 500 + 2 * 70e-6 / 16e-6, 1e-9);
}

TEST(EnergyTank, TheBrakeTakesNoMoreThanTheRiseCosts)
{
    EnergyTank tank;
    static_cast<void>(tank.step(at(500, 0)));

    const EnergyTankOutput out = tank.step(at(501, 2e-3, 0, 0.2)); // 2 uJ over 0.2 mm are 0.01 N

    EXPECT_NEAR(out.brake, 0.01, 1e-12);
    EXPECT_EQ(out.used, 0);
    EXPECT_EQ(out.stiffness, 501);
}

TEST(EnergyTank, IncomeStopsAtTheLimit)
{
    EnergyTank tank;
    for (int n = 0; n < 10000; ++n) static_cast<void>(tank.step(at(500, 2e-3, 0.3, 0.3)));
    EXPECT_EQ(tank.energy(), 2e-3);
}

TEST(EnergyTank, HoldsItsInvariantsOnRoughInput)
{
    EnergyTank                             tank;
    std::mt19937                           random(7);
    std::uniform_real_distribution<double> stiffness(0, 2000), depth(-2e-3, 8e-3), speed(-1, 1);
    double                                 rendered = 0;
    for (int n = 0; n < 200000; ++n) {
        const EnergyTankInput  in  = at(stiffness(random), depth(random), speed(random), speed(random));
        const double           had = tank.energy();
        const EnergyTankOutput out = tank.step(in);
        const double           d   = std::max(in.depth, 0.0);

        ASSERT_GE(tank.energy(), 0);
        ASSERT_LE(tank.energy(), 2e-3);
        ASSERT_LE(out.stiffness, in.stiffness + 1e-9) << "rounding";
        ASSERT_LE(out.brake, 0.3 * rendered * d + 1e-12) << "rounding";
        const double income = (in.normalSpeed * in.normalSpeed + in.tangentialSpeed * in.tangentialSpeed + 1e-3) * kDt;
        const double paid   = out.brake * std::abs(in.tangentialSpeed) * kDt;
        ASSERT_LE(d * d * (out.stiffness - rendered) / 2, paid + had + income + 1e-12) << "a rise without payment";
        rendered = out.stiffness;
    }
}

TEST(EnergyTank, WhatIsNotFiniteEndsTheContact)
{
    for (int field = 0; field < 5; ++field)
        for (double bad : {kNan, std::numeric_limits<double>::infinity()}) {
            EnergyTank tank;
            static_cast<void>(tank.step(at(500, 0)));
            EnergyTankInput in    = at(500, 2e-3);
            double*         all[] = {&in.stiffness, &in.depth, &in.normalSpeed, &in.tangentialSpeed, &in.dt};
            *all[field]           = bad;

            const EnergyTankOutput out = tank.step(in);

            EXPECT_EQ(out.stiffness, 0) << field;
            EXPECT_EQ(out.brake, 0) << field;
            EXPECT_EQ(tank.energy(), 0) << field;
        }
    EnergyTankInput backwards = at(500, 2e-3, 1, 1);
    backwards.dt              = -5;
    EnergyTank tank;
    static_cast<void>(tank.step(backwards));
    EXPECT_GE(tank.energy(), 0);
}

TEST(EnergyTank, RefusesSettingsOutOfRangeByName)
{
    EnergyTankSettings settings;
    settings.brake = -1;
    try {
        EnergyTank tank(settings);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("brake"), std::string::npos);
    }
}

// A finger presses at 0.05 m/s, slides over an edge 6 mm wide from a soft to a stiff spot at constant depth, and is
// lifted.
struct Cycle {
    double soft, stiff;  // [N/m]
    double depth, speed; // [m], [m/s] of sliding
};

struct Gain {
    double work = 0; // [J] that the hand gained
    double lag  = 0; // [1] largest, of the stiffness in use behind the wanted one
    double peak = 0; // [N] of the brake
};

Gain workGained(const Cycle& cycle, EnergyTank* tank)
{
    const double press = 0.05; // [m/s]
    const double down = cycle.depth / press, across = 0.04 / cycle.speed;
    Gain         gain;
    for (double t = 0, depth = 0, s = -0.02; t < 2 * down + across; t += kDt) {
        const double z  = t < down            ? press * t
                          : t < down + across ? cycle.depth
                                              : cycle.depth - press * (t - down - across);
        const double x  = -0.02 + cycle.speed * std::clamp(t - down, 0.0, across);
        const double vz = (z - depth) / kDt, vx = (x - s) / kDt;
        const double wanted = cycle.soft + (cycle.stiff - cycle.soft) * (1 + std::tanh(x / 3e-3)) / 2;
        double       used = wanted, brake = 0;
        if (tank) {
            const EnergyTankOutput out = tank->step({wanted, z, vz, vx, kDt});
            used                       = out.stiffness;
            brake                      = out.brake;
        }
        // The force pushes out while the hand goes in by z - depth; the brake holds while it goes on.
        gain.work += -used * (z + depth) / 2 * (z - depth) - brake * std::abs(x - s);
        if (z > 0) gain.lag = std::max(gain.lag, 1 - used / wanted);
        gain.peak = std::max(gain.peak, brake);
        depth     = z;
        s         = x;
    }
    return gain;
}

TEST(EnergyTank, WithoutItEachCycleGivesTheStoredStepToTheHand)
{
    EXPECT_NEAR(workGained({100, 1000, 5e-3, 0.05}, nullptr).work, 11.25e-3, 0.15e-3) << "d^2 (K2 - K1) / 2";
    EXPECT_NEAR(workGained({250, 800, 2e-3, 0.05}, nullptr).work, 1.1e-3, 0.05e-3) << "d^2 (K2 - K1) / 2";
}

TEST(EnergyTank, WorkPerCycleAndLagAreThoseOfTheRule)
{
    struct Row {
        Cycle  cycle;
        double brake; // settings.brake
        double lag;   // [1] allowed
        double work;  // [J] allowed
    };
    std::printf("  K1 -> K2 N/m  depth  speed   mu | plain mJ  tank mJ   lag  brake\n");
    for (const Row& row :
         {Row{{250, 800, 2e-3, 0.05}, 0.3, 0.005, 1.15e-3}, Row{{250, 800, 2e-3, 0.2}, 0.3, 0.005, 1.15e-3},
          Row{{250, 800, 3e-3, 0.05}, 0.3, 0.005, 1.15e-3}, Row{{250, 800, 3e-3, 0.2}, 0.3, 0.005, 1.15e-3},
          Row{{100, 1000, 2e-3, 0.05}, 0.3, 0.005, 1.15e-3}, Row{{100, 1000, 2e-3, 0.2}, 0.3, 0.005, 1.15e-3},
          Row{{100, 1000, 3e-3, 0.05}, 0.3, 0.005, 1.15e-3}, Row{{100, 1000, 3e-3, 0.2}, 0.3, 0.005, 1.15e-3},
          Row{{250, 800, 5e-3, 0.05}, 0.3, 0.005, 1.15e-3}, Row{{250, 800, 5e-3, 0.2}, 0.3, 0.005, 1.15e-3},
          Row{{100, 1000, 5e-3, 0.05}, 0.3, 0.41, 4e-3}, Row{{100, 1000, 5e-3, 0.2}, 0.3, 0.19, 4e-3},
          Row{{100, 1000, 5e-3, 0.05}, 0.5, 0.15, 4e-3}, Row{{100, 1000, 5e-3, 0.2}, 0.5, 0.005, 4e-3}}) {
        EnergyTankSettings settings;
        settings.brake = row.brake;
        EnergyTank   tank(settings);
        const double plain = workGained(row.cycle, nullptr).work;
        double       work = 0, lag = 0, peak = 0;
        for (int n = 0; n < 5; ++n) {
            const Gain gain = workGained(row.cycle, &tank);
            work            = std::max(work, gain.work);
            lag             = std::max(lag, gain.lag);
            peak            = std::max(peak, gain.peak);
        }
        std::printf("  %4.0f -> %4.0f  %4.0f mm  %4.2f  %3.1f | %8.2f %8.2f %4.0f %% %5.2f N\n", row.cycle.soft,
                    row.cycle.stiff, row.cycle.depth * 1e3, row.cycle.speed, row.brake, plain * 1e3, work * 1e3,
                    lag * 100, peak);
        EXPECT_LE(work, row.work)
            << "as the rule gave in its own simulation, 1.1 mJ to two digits; else the tank's 2 mJ and what fills it";
        EXPECT_LE(lag, row.lag) << "as simulated for the rule";
    }
}

} // namespace
} // namespace palp
