#include "engine/force/energy_tank.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/force/lateral_lean.h"

namespace palp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDt  = 1e-3; // [s]

static_assert(std::is_trivially_copyable_v<EnergyTank>, "it owns nothing, so it cannot allocate");
static_assert(noexcept(std::declval<EnergyTank&>().step({})));

EnergyTankInput at(double stiffness, double depth, double normalSpeed = 0, double tangentialSpeed = 0, double drag = 0)
{
    return {stiffness, depth, normalSpeed, tangentialSpeed, kDt, drag};
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
    EXPECT_EQ(tank.energy(), 0);
    EXPECT_NEAR(tank.step(at(1000, 5e-3)).stiffness, 116.16 + 2 * 1e-6 / 25e-6, 1e-9) << "1 mW goes on";
}

TEST(EnergyTank, TakesInWhatTheSpringLeavesOfTheArmsDampingAndNoMoreThanItsOwn)
{
    for (const auto& [spare, taken] : {std::pair{std::numeric_limits<double>::infinity(), 1.5},
                                       {1.6, 1.5},
                                       {1.4, 1.4},
                                       {0.1, 0.1},
                                       {0.0, 0.0},
                                       {-1.0, 0.0}}) {
        EnergyTank      tank({.damping = 1.5, .power = 0});
        const double    had   = tank.energy();
        EnergyTankInput moved = at(500, 0, -0.1, 0.2);
        moved.spareDamping    = spare;
        static_cast<void>(tank.step(moved));
        EXPECT_NEAR(tank.energy() - had, taken * (0.01 + 0.04) * kDt, 1e-16) << spare << " N s/m";
    }
}

EnergyTankSettings withoutIncome()
{
    EnergyTankSettings settings;
    settings.power = settings.damping = 0;
    return settings;
}

TEST(EnergyTank, TheHandPaysFirst)
{
    EnergyTank tank(withoutIncome());
    static_cast<void>(tank.step(at(500, 0)));
    const double had = tank.energy();

    // 1 N/m more, 4 mm deep, is 8 uJ; the hand drags the proxy by 0.1 mm with a tangent of 0.1 mm, 500 N/m: 5 uJ.
    const EnergyTankOutput out = tank.step(at(501, 4e-3, 0, 0.1, 0.1e-3 * 0.1e-3));

    EXPECT_NEAR(out.used, 3e-6, 1e-15);
    EXPECT_NEAR(out.stiffness, 501, 1e-12);
    EXPECT_NEAR(tank.energy(), had - 3e-6, 1e-15);
}

TEST(EnergyTank, WhatTheHandPaysBeyondTheRiseIsFrictionsAndLost)
{
    EnergyTank tank(withoutIncome());
    static_cast<void>(tank.step(at(500, 0)));
    const double had = tank.energy();

    const EnergyTankOutput out = tank.step(at(501, 2e-3, 0, 0.2, 1e-6)); // 0.5 mJ for 2 uJ

    EXPECT_EQ(out.used, 0);
    EXPECT_EQ(out.stiffness, 501);
    EXPECT_EQ(tank.energy(), had);
}

TEST(EnergyTank, AFallThatPushedTheHandAlongIsNotGivenTwice)
{
    EnergyTank tank(withoutIncome());
    static_cast<void>(tank.step(at(500, 0)));
    const double had = tank.energy();

    // 10 N/m less, 4 mm deep, are 80 uJ; 500 N/m times 0.1 mm^2 of drag gave the hand 50 of them.
    EXPECT_EQ(tank.step(at(490, 4e-3, 0, 0.1, -0.1e-6)).stiffness, 490);
    EXPECT_NEAR(tank.energy(), had + 30e-6, 1e-15);

    const EnergyTankOutput out = tank.step(at(490, 4e-3, 0, 0.1, -0.1e-6)); // pushed by a slope that was none
    EXPECT_EQ(out.stiffness, 490);
    EXPECT_NEAR(out.used, 49e-6, 1e-15) << "the tank pays for it";
}

TEST(EnergyTank, AContactWithoutStiffnessLeavesItAsItIs)
{
    EnergyTank   tank(withoutIncome());
    const double had = tank.energy();
    EXPECT_EQ(tank.step(at(0, 2e-3)).stiffness, 0);
    EXPECT_EQ(tank.energy(), had);
    EXPECT_GT(had, 0);
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
    std::uniform_real_distribution<double> stiffness(0, 2000), depth(-2e-3, 8e-3), speed(-1, 1), drag(-1e-7, 1e-7);
    double                                 rendered = 0;
    for (int n = 0; n < 200000; ++n) {
        const EnergyTankInput  in  = at(stiffness(random), depth(random), speed(random), speed(random), drag(random));
        const double           had = tank.energy();
        const EnergyTankOutput out = tank.step(in);
        const double           d   = std::max(in.depth, 0.0);

        ASSERT_GE(tank.energy(), 0);
        ASSERT_LE(tank.energy(), 2e-3);
        ASSERT_LE(out.stiffness, in.stiffness + 1e-9) << "rounding";
        const double income = (in.normalSpeed * in.normalSpeed + in.tangentialSpeed * in.tangentialSpeed + 1e-3) * kDt;
        const double paid   = std::max(0.0, rendered * in.drag);
        ASSERT_LE(d * d * (out.stiffness - rendered) / 2, paid + had + income + 1e-12) << "a rise without payment";
        rendered = out.stiffness;
    }
}

TEST(EnergyTank, WhatIsNotFiniteEndsTheContact)
{
    for (int field = 0; field < 10; ++field)
        for (double bad : {kNan, std::numeric_limits<double>::infinity()}) {
            if (field >= 8 && bad > 0) continue; // these two may be without a bound
            EnergyTank tank;
            static_cast<void>(tank.step(at(500, 0)));
            EnergyTankInput in    = at(500, 2e-3);
            double*         all[] = {&in.stiffness, &in.depth,      &in.normalSpeed, &in.tangentialSpeed, &in.dt,
                                     &in.drag,      &in.stiffening, &in.storedShare, &in.spareDamping,    &in.steepest};
            *all[field]           = bad;

            const EnergyTankOutput out = tank.step(in);

            EXPECT_EQ(out.stiffness, 0) << field;
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
    settings.power = -1;
    try {
        EnergyTank tank(settings);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("power"), std::string::npos);
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
    double peak = 0; // [N] of the tangential force
};

enum class Sideways { nothing, leans };

/// \param sideways  whether the pull leans away from the stiff side
Gain workGained(const Cycle& cycle, EnergyTank* tank, Sideways sideways)
{
    const double press = 0.05; // [m/s]
    const double down = cycle.depth / press, across = 0.04 / cycle.speed;
    Gain         gain;
    LateralLean  lean;
    double       proxy = -0.02; // [m] its place along the way
    for (double t = 0, depth = 0, s = -0.02; t < 2 * down + across; t += kDt) {
        const double z  = t < down            ? press * t
                          : t < down + across ? cycle.depth
                                              : cycle.depth - press * (t - down - across);
        const double x  = -0.02 + cycle.speed * std::clamp(t - down, 0.0, across);
        const double vz = (z - depth) / kDt, vx = (x - s) / kDt;
        const auto   law = [&](double at) {
            return cycle.soft + (cycle.stiff - cycle.soft) * (1 + std::tanh(at / 3e-3)) / 2;
        };
        const double wanted = law(x), tilt = lean.way().x;
        double       used = wanted;
        if (tank) used = tank->step({wanted, std::hypot(z, tilt), vz, vx, kDt, -tilt * (x + tilt - proxy)}).stiffness;
        // The force pushes out while the hand goes in by z - depth, and sideways while it goes on.
        gain.work += -used * (z + depth) / 2 * (z - depth) + used * tilt * (x - s);
        if (z > 0) gain.lag = std::max(gain.lag, 1 - used / wanted);
        gain.peak          = std::max(gain.peak, std::abs(used * tilt));
        proxy              = x + tilt;
        const double slope = std::log(law(x + 1e-6) / law(x - 1e-6)) / 2e-6;
        if (sideways == Sideways::leans) lean.step({{slope, 0, 0}, 0}, {tilt, 0, z}, std::hypot(x - s, z - depth));
        depth = z;
        s     = x;
    }
    return gain;
}

/// The tank's arithmetic while every contact was a spring.
struct TankOfSprings {
    double energy = 0.2e-3, stiffness = 0; // [J], [N/m]

    EnergyTankOutput step(const EnergyTankInput& in)
    {
        const double speed = std::abs(in.tangentialSpeed), depth = std::max(in.depth, 0.0);
        energy = std::min(2e-3, energy + (1.0 * (in.normalSpeed * in.normalSpeed + speed * speed) + 1e-3) * in.dt);
        EnergyTankOutput out;
        const double     rise = depth * depth * (in.stiffness - stiffness) / 2, paid = stiffness * in.drag;
        const double     need = rise - paid;
        if (need <= 0) {
            energy    = std::min(2e-3, energy + std::min(-need, std::max(-rise, 0.0)));
            stiffness = in.stiffness;
        } else {
            out.used = std::min(energy, need);
            energy -= out.used;
            const double share = rise > 0 ? std::clamp((paid + out.used) / rise, 0.0, 1.0) : 1;
            stiffness += (in.stiffness - stiffness) * share;
        }
        out.stiffness = stiffness;
        out.stored    = stiffness * depth * depth / 2;
        return out;
    }
};

TEST(EnergyTank, OfSpringsItIsThatOfSpringsToTheBit)
{
    std::mt19937                           random(5);
    std::uniform_real_distribution<double> share(-1, 1);
    EnergyTank                             tank;
    TankOfSprings                          before;
    int                                    waited = 0;
    for (int n = 0; n < 100'000; ++n) {
        EnergyTankInput in         = at(550 + 450 * share(random), 4e-3 * share(random), 0.1 * share(random),
                                        0.2 * share(random), 1e-7 * share(random));
        in.steepest                = 1000;
        const EnergyTankOutput now = tank.step(in), then = before.step(in);
        ASSERT_EQ(now.stiffness, then.stiffness) << n;
        ASSERT_EQ(now.used, then.used) << n;
        ASSERT_EQ(now.stored, then.stored) << n;
        ASSERT_EQ(tank.energy(), before.energy) << n;
        ASSERT_EQ(now.law.secant(in.depth), now.stiffness) << n;
        waited += now.stiffness < in.stiffness;
    }
    EXPECT_GT(waited, 1000) << "or no rise had to wait";
}

TEST(EnergyTank, ALawThatStiffensIsPaidByItsOwnEnergy)
{
    EnergyTank      tank;
    EnergyTankInput in = at(100, 0);
    in.stiffening      = 500;
    in.steepest        = 1000;
    static_cast<void>(tank.step(in));
    in.stiffness        = 900; // beyond the cap at 5 mm either way
    in.depth            = 5e-3;
    const double before = DepthLaw{100, 500, 1000}.energy(5e-3);

    const EnergyTankOutput out = tank.step(in);

    EXPECT_NEAR(out.used, 0.202e-3, 1e-15) << "all it had";
    EXPECT_LE(out.stored, before + 0.202e-3 + 1e-12);
    EXPECT_GT(out.stored, before + 0.1e-3) << "a chord of the energy is within half of it";
    EXPECT_LT(out.stiffness, 300);
    in.storedShare    = 0.5;
    const double half = tank.step(in).used;
    EXPECT_NEAR(half, 1e-6, 1e-12) << "what came in since";
}

TEST(EnergyTank, WhatStiffensIsLetInInPartAndPaidForToTheEnd)
{
    EnergyTank      tank;
    EnergyTankInput in = at(300, 0);
    in.stiffening      = 100;
    in.steepest        = 4000;
    static_cast<void>(tank.step(in));
    in.stiffening       = 600; // the stiffness stays: only how it stiffens is not affordable at once
    in.depth            = 4e-3;
    const double before = DepthLaw{300, 100, 4000}.energy(4e-3), wanted = DepthLaw{300, 600, 4000}.energy(4e-3);
    ASSERT_GT(wanted - before, 0.3e-3) << "more than the tank holds";

    const EnergyTankOutput out = tank.step(in);

    EXPECT_GT(out.law.stiffening, 110);
    EXPECT_LT(out.law.stiffening, 590);
    EXPECT_LE(out.law.energy(4e-3), before + out.used + 1e-12) << "1e-9 of the share, by halving it";
    EXPECT_GT(out.law.energy(4e-3), before + 0.5 * out.used) << "and it takes what it paid for";
}

TEST(EnergyTank, WithoutItEachCycleGivesTheStoredStepToTheHand)
{
    EXPECT_NEAR(workGained({100, 1000, 5e-3, 0.05}, nullptr, Sideways::nothing).work, 11.25e-3, 0.15e-3)
        << "d^2 (K2 - K1) / 2";
    EXPECT_NEAR(workGained({250, 800, 2e-3, 0.05}, nullptr, Sideways::nothing).work, 1.1e-3, 0.05e-3)
        << "d^2 (K2 - K1) / 2";
}

TEST(LateralLean, GivesEachCycleBackWhatItTookAndLeavesNothingToTheTank)
{
    std::printf("  K1 -> K2 N/m  depth  speed | plain mJ  with mJ   lag  sideways\n");
    for (const Cycle& cycle : {Cycle{250, 800, 2e-3, 0.05}, Cycle{250, 800, 2e-3, 0.2}, Cycle{250, 800, 3e-3, 0.05},
                               Cycle{250, 800, 3e-3, 0.2}, Cycle{100, 1000, 2e-3, 0.05}, Cycle{100, 1000, 2e-3, 0.2},
                               Cycle{100, 1000, 3e-3, 0.05}, Cycle{100, 1000, 3e-3, 0.2}, Cycle{250, 800, 5e-3, 0.05},
                               Cycle{250, 800, 5e-3, 0.2}}) {
        EnergyTank   tank;
        const double plain = workGained(cycle, nullptr, Sideways::nothing).work;
        Gain         most;
        for (int n = 0; n < 5; ++n) {
            const Gain gain = workGained(cycle, &tank, Sideways::leans);
            most = {std::max(most.work, gain.work), std::max(most.lag, gain.lag), std::max(most.peak, gain.peak)};
        }
        std::printf("  %4.0f -> %4.0f  %4.0f mm  %4.2f | %8.2f %8.3f %4.1f %% %5.2f N\n", cycle.soft, cycle.stiff,
                    cycle.depth * 1e3, cycle.speed, plain * 1e3, most.work * 1e3, most.lag * 100, most.peak);
        EXPECT_LE(most.work, 0.02 * plain) << "of what it was; the force is a tick late";
        EXPECT_LE(most.lag, 0.005) << "nothing waits";
    }
}

TEST(LateralLean, IsTheGradientOfTheStoredEnergy)
{
    // K(s) = 500 exp(100 s), 2 mm deep below a bulge of radius 20 mm.
    LateralLean      lean;
    constexpr double kDepth = 2e-3, kCurvature = 50;
    for (int n = 0; n < 50; ++n) lean.step({{100, 0, 0}, kCurvature}, lean.way() + glm::dvec3(0, 0, kDepth), 0);
    EXPECT_NEAR(lean.way().x, -kDepth * kDepth / 2 * 100 / (1 - kCurvature * kDepth), 1e-12);
    EXPECT_EQ(lean.way().y, 0);
    EXPECT_EQ(lean.way().z, 0);
    lean.end();
    EXPECT_EQ(lean.way(), glm::dvec3(0));
}

TEST(LateralLean, GoesByTheStoredEnergyWhereThatIsStated)
{
    LateralLean lean, none;
    for (int n = 0; n < 200; ++n) {
        lean.step({{100, 0, 0}, 0, 1e-6}, lean.way() + glm::dvec3(0, 0, 3e-3), 1e-3);
        none.step({{100, 0, 0}, 0, 0}, none.way() + glm::dvec3(0, 0, 3e-3), 1e-3);
    }
    EXPECT_NEAR(lean.way().x, -1e-4, 1e-12) << "1e-6 m^2 times 100 / m; as a spring it would be 4.5 times that";
    EXPECT_EQ(glm::length(none.way()), 0) << "a contact that stores nothing leans nowhere";
}

TEST(LateralLean, IsBoundedAndNeverJumps)
{
    LateralLean lean;
    glm::dvec3  last{};
    for (int n = 0; n < 200; ++n) { // a slope that turns round every 50 ticks, far too steep
        lean.step({{n / 50 % 2 == 0 ? 5000.0 : -5000.0, 0, 0}, 0}, lean.way() + glm::dvec3(0, 0, 4e-3), 0.1e-3);
        EXPECT_LE(glm::length(lean.way() - last), 0.5 * 0.1e-3 + 0.02e-3 + 1e-15) << n;
        EXPECT_LE(glm::length(lean.way()), 0.5 * 4e-3 + 1e-15) << n;
        last = lean.way();
    }
    EXPECT_GT(glm::length(lean.way()), 1e-3) << "or nothing was bounded";
    for (int field = 0; field < 3; ++field) {
        StiffnessSlope slope{{100, 0, 0}, 0};
        glm::dvec3     pull{0, 0, 2e-3};
        double         travel                                             = 0;
        (field == 0 ? slope.ofLogarithm.y : field == 1 ? pull.z : travel) = kNan;
        lean.step(slope, pull, travel);
        EXPECT_EQ(lean.way(), glm::dvec3(0)) << field;
    }
}

TEST(EnergyTank, AShapeThatRisesUnderALoadedFingerIsPaidFor)
{
    EnergyTank tank({.limit = 2e-3, .start = 0.01e-3, .damping = 0, .power = 0});
    DepthShape harder{.step = 0.2e-3};
    for (std::size_t n = 0; n < harder.tangents.size(); ++n) harder.tangents[n] = 1 + 0.5 * double(n);
    const EnergyTankInput soft{.stiffness = 100, .depth = 2e-3, .dt = 1e-3};
    EnergyTankInput       hard = soft;
    hard.shape                 = harder;
    tank.step({.stiffness = 100, .depth = 0, .dt = 1e-3}); // in free space all is free
    const double before = tank.step(soft).stored, wanted = DepthLaw::capped(100, 0, 1e9, harder).energy(2e-3);
    ASSERT_GT(wanted - before, 0.1e-3);
    const EnergyTankOutput out = tank.step(hard);
    EXPECT_LE(out.stored - before, out.used * (1 + 1e-6)); // what the halvings leave
    EXPECT_LE(out.used, 0.01e-3);
    EXPECT_GT(out.stored, before); // as far as the tank pays
    EXPECT_EQ(tank.step(soft).law.shape, DepthShape{});
}

/// From a dome that has given way to a spring that is softer at the surface and harder where the hand is: the rise
/// waits, and the lower cap, which the loop asks for, holds at once.
TEST(EnergyTank, ALawOnItsWayIsWithinTheLowerCap)
{
    EnergyTank tank({.limit = 2e-3, .start = 0.01e-3, .damping = 0, .power = 0});
    DepthShape dome{.step = 0.02e-3};
    dome.tangents.fill(0.05);
    dome.tangents[0] = 1;
    EnergyTankInput in{.stiffness = 1000, .depth = 0, .dt = 1e-3, .shape = dome};
    tank.step(in);
    in                         = {.stiffness = 300, .depth = 2e-3, .dt = 1e-3, .steepest = 300};
    const EnergyTankOutput out = tank.step(in);
    ASSERT_LT(out.law.energy(2e-3), DepthLaw::capped(300, 0, 300).energy(2e-3)) << "or all was paid for";
    EXPECT_EQ(out.law.steepest, 300);
    EXPECT_LE(out.law.stiffness, 300);
    EXPECT_LE(out.law.mostTangent(2e-3), 300);
}

} // namespace
} // namespace palp
