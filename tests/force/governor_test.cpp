#include "engine/force/governor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/force/governor_servo.h"

namespace palp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

static_assert(std::is_trivially_copyable_v<ForceGovernor>, "it owns nothing, so it cannot allocate");
static_assert(noexcept(std::declval<ForceGovernor&>().step({})) && noexcept(std::declval<ForceGovernor&>().reset()));

// ---- 1: what came in can be believed

TEST(ForceGovernor, PassesAnHonestForceUnchanged)
{
    Servo servo;
    servo.engaged();

    for (int n = 0; n < 100; ++n) {
        servo.in.force = {0.03 * n, -0.01 * n, 0.02 * n};
        EXPECT_EQ(servo.tick().force, servo.in.force);
    }
    EXPECT_EQ(servo.tick().actions, 0U);
}

TEST(ForceGovernor, WhatIsNotFiniteIsAFaultWithItsOwnReason)
{
    for (double bad : {kNan, kInfinity, -kInfinity})
        for (int axis = 0; axis < 3; ++axis) {
            for (auto [field, reason] : {std::pair{&GovernorInput::force, GovernorFault::forceNotFinite},
                                         {&GovernorInput::position, GovernorFault::positionNotFinite},
                                         {&GovernorInput::velocity, GovernorFault::velocityNotFinite}}) {
                Servo servo;
                servo.pushing({0, 0, 5});
                (servo.in.*field)[axis] = bad;

                const GovernorOutput first = servo.tick();
                (servo.in.*field)[axis]    = 0;

                EXPECT_EQ(first.fault, reason);
                EXPECT_NEAR(first.force.z, 4 * 0.95, kRounding) << "one tick of slew and of the fault ramp";
                expectGoneIn20Ticks(servo, name(reason));
            }
            Servo servo;
            servo.pushing({0, 0, 5});
            servo.in.dt = bad;
            EXPECT_EQ(servo.tick().fault, GovernorFault::clockNotFinite);
            expectGoneIn20Ticks(servo, "clock");
        }
}

TEST(ForceGovernor, AnEnergyThatIsNotANumberIsTheForcesFault)
{
    for (double GovernorInput::*field : {&GovernorInput::admittedEnergy, &GovernorInput::storedEnergy}) {
        Servo servo;
        servo.pushing({0, 0, 5});
        servo.in.*field = kNan;
        EXPECT_EQ(servo.tick().fault, GovernorFault::forceNotFinite);
        expectGoneIn20Ticks(servo, "energy");
    }
}

TEST(ForceGovernor, AGripThatJumpsLosesTheForceAndEngagesAnew)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.position.x += 6e-3; // a hand that is 1.2 m/s fast moves by 1.2 mm
    const GovernorOutput first = servo.tick();
    EXPECT_TRUE(first.did(GovernorAction::jumped));
    EXPECT_EQ(first.fault, GovernorFault::none);
    EXPECT_LE(first.force.z, 4);
    for (int n = 0; n < 5; ++n) servo.tick();
    EXPECT_EQ(servo.tick().force, glm::dvec3(0));
    EXPECT_EQ(servo.ticks(3000).force, glm::dvec3(0)) << "it is pressed in where the jump has left it";
    servo.in.force = {};
    servo.engaged();
}

/// In free space, and at once as deep inside of a body as no hand gets in a tick.
TEST(ForceGovernor, AGripThatJumpsIntoABodyIsNotPushed)
{
    Servo servo;
    servo.engaged();
    servo.in.position.z -= 10e-3;
    servo.in.force = {0, 0, 6};
    for (int n = 0; n < 3000; ++n) ASSERT_EQ(servo.tick().force, glm::dvec3(0)) << n;
}

TEST(ForceGovernor, AFastHandAndAnAnswerThatComesLateAreNoJumps)
{
    Servo servo;
    servo.engaged();
    for (int n = 0; n < 100; ++n) {
        servo.in.position.x += 1.1e-3;
        ASSERT_FALSE(servo.tick().did(GovernorAction::jumped));
    }
    for (int n = 1; n <= 15; ++n) { // the device says nothing for 15 ms
        servo.in.sinceAnswer     = 1e-3 * n;
        servo.in.missedExchanges = n;
        ASSERT_FALSE(servo.tick().did(GovernorAction::jumped));
    }
    servo.in.position.x += 16 * 1.1e-3;
    servo.in.sinceAnswer = servo.in.missedExchanges = 0;
    EXPECT_FALSE(servo.tick().did(GovernorAction::jumped));
}

TEST(ForceGovernor, AFaultStaysUntilTheOperatorResetsItAndThenEngagesAnew)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.force.x = kNan;
    servo.tick();
    servo.in.force = {0, 0, 5};

    EXPECT_EQ(servo.ticks(5000).force, glm::dvec3(0)) << "the cause has gone, the fault has not";
    servo.in.force = {};
    EXPECT_EQ(servo.ticks(5000).fault, GovernorFault::forceNotFinite);

    servo.governor.reset();
    EXPECT_EQ(servo.governor.fault(), GovernorFault::none);
    servo.in.force = {0, 0, 5};
    EXPECT_EQ(servo.ticks(5000).force, glm::dvec3(0)) << "still pressed in";
    servo.in.force = {};
    servo.engaged();
}

TEST(ForceGovernor, ACauseThatLastsIsFoundAgainAfterAReset)
{
    Servo servo;
    servo.in.force.x = kNan;
    servo.tick();
    servo.governor.reset();
    EXPECT_EQ(servo.tick().fault, GovernorFault::forceNotFinite);
}

TEST(ForceGovernor, ResetWithoutAFaultChangesNothing)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.governor.reset();
    EXPECT_EQ(servo.tick().force.z, 5);
}

TEST(ForceGovernor, TheFirstReasonIsKept)
{
    Servo servo;
    servo.engaged();
    servo.in.position.y = kNan;
    servo.tick();
    servo.in.force.x = kNan;
    EXPECT_EQ(servo.tick().fault, GovernorFault::positionNotFinite);
}

TEST(ForceGovernor, AClockThatStopsIsAFaultAfter20TicksAndLetsNoForceGrow)
{
    Servo servo;
    servo.pushing({0, 0, 1});
    servo.in.dt    = 0;
    servo.in.force = {0, 0, 5};

    for (int n = 0; n < 20; ++n) {
        const GovernorOutput out = servo.tick();
        EXPECT_EQ(out.force.z, 1) << "no time, no growth";
        EXPECT_EQ(out.fault, GovernorFault::none);
    }
    EXPECT_EQ(servo.tick().fault, GovernorFault::clockStopped);
    expectGoneIn20Ticks(servo, "though dt stays 0");
}

TEST(ForceGovernor, AClockThatRunsBackwardsCountsAsStopped)
{
    Servo servo;
    servo.pushing({0, 0, 1});
    servo.in.dt = -1e-3;
    EXPECT_EQ(servo.ticks(21).fault, GovernorFault::clockStopped);
    expectGoneIn20Ticks(servo, "dt below 0");
}

TEST(ForceGovernor, FiveSecondsWithoutATickAreAFaultAndZeroAtOnce)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.dt = 5;

    const GovernorOutput out = servo.tick();

    EXPECT_EQ(out.fault, GovernorFault::loopStalled);
    EXPECT_EQ(out.force, glm::dvec3(0));
}

TEST(ForceGovernor, ALateTickIsNoFaultAndLetsAForceGrowByFourMilliseconds)
{
    Servo servo;
    servo.pushing({0, 0, 1});
    servo.in.dt    = 0.09;
    servo.in.force = {0, 0, 6};

    const GovernorOutput out = servo.tick();

    EXPECT_EQ(out.fault, GovernorFault::none);
    EXPECT_NEAR(out.force.z, 5, kRounding);
    servo.in.force = {};
    EXPECT_EQ(servo.tick().force.z, 0) << "but fall by all of it";
}

TEST(ForceGovernor, MoreThan20MissedExchangesAreALostDevice)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.missedExchanges = 20;
    EXPECT_EQ(servo.tick().fault, GovernorFault::none);
    servo.in.missedExchanges = 21;
    EXPECT_EQ(servo.tick().fault, GovernorFault::deviceLost);
    expectGoneIn20Ticks(servo, "lost");
}

// ---- 2: homed and in the box

TEST(ForceGovernor, NotHomedOutsideTheBoxClutchedOrAskedToLetGoIsZeroWithoutAFaultAndEngagesAnew)
{
    for (auto [flag, action] : {std::pair{&GovernorInput::homed, GovernorAction::notHomed},
                                {&GovernorInput::inBox, GovernorAction::outsideBox},
                                {&GovernorInput::letGo, GovernorAction::lettingGo},
                                {&GovernorInput::clutched, GovernorAction::clutched}}) {
        Servo      servo;
        const bool good = servo.in.*flag;
        servo.pushing({0, 0, 5});
        servo.in.*flag = !good;

        const GovernorOutput first = servo.tick();
        EXPECT_TRUE(first.did(action));
        EXPECT_EQ(first.fault, GovernorFault::none);
        EXPECT_NEAR(first.force.z, 4, kRounding) << "it leaves at 1 N/ms";

        servo.in.*flag = good; // one tick was enough
        expectGoneIn20Ticks(servo, "outside");
        EXPECT_EQ(servo.ticks(1000).force, glm::dvec3(0)) << "pressed in";
        servo.in.force = {};
        servo.engaged();
    }
}

TEST(ForceGovernor, AHandThatWasNotInFreeSpaceYetGetsNoForceHoweverCalm)
{
    Servo servo;
    servo.in.behind = true;
    servo.in.force  = {0, 0, 0.1};
    EXPECT_EQ(servo.ticks(3000).force, glm::dvec3(0)) << "below the force of a calm hand";
    servo.in.behind = false;
    EXPECT_GT(servo.ticks(3000).force.z, 0.05);
}

TEST(ForceGovernor, APositionThatJumpsWhileHomingIsNotCountedAsWork)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.homed    = false;
    servo.in.position = {0, 0, 0.1};
    EXPECT_NEAR(servo.tick().energy, 0, kRounding);
    servo.in.homed    = true;
    servo.in.position = {0, 0, -0.1};
    EXPECT_NEAR(servo.tick().energy, 0, kRounding);
}

// ---- 3: fresh

TEST(ForceGovernor, AStaleForceIsHeldFor5MillisecondsAndGoneIn20More)
{
    Servo servo;
    servo.pushing({0, 0, 5});

    for (int age = 0; age <= 30; ++age) { // [ms]
        servo.in.forceAge          = age * 1e-3;
        const GovernorOutput out   = servo.tick();
        const double         share = age <= 5 ? 1 : std::max(0.0, 1 - (age - 5) / 20.0);
        EXPECT_NEAR(out.force.z, 5 * share, kRounding) << age << " ms";
        EXPECT_EQ(out.did(GovernorAction::stale), age > 5) << age << " ms";
        EXPECT_EQ(out.fault, GovernorFault::none);
    }
}

TEST(ForceGovernor, AForceThatComesBackInTimeSlewsBack)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.forceAge = 15e-3;
    EXPECT_NEAR(servo.ticks(10).force.z, 2.5, kRounding);
    servo.in.forceAge = 0;
    EXPECT_NEAR(servo.tick().force.z, 3.5, kRounding);
    EXPECT_NEAR(servo.ticks(2).force.z, 5, kRounding);
}

TEST(ForceGovernor, AfterFiveSecondsWithoutANewForceItEngagesAnew)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    for (int n = 0; n < 5000; ++n) {
        servo.in.forceAge = n * 1e-3;
        const double z    = servo.tick().force.z;
        ASSERT_TRUE(z >= 0 && z <= 5);
        if (n >= 25) {
            ASSERT_EQ(z, 0);
        }
    }
    servo.in.forceAge = 0;
    EXPECT_EQ(servo.ticks(1000).force.z, 0) << "the hand has sunk in: 5 N would throw it out";
    servo.in.force = {};
    servo.engaged();
}

TEST(ForceGovernor, AForceThatNeverWasOrWhoseAgeIsUnknownIsStale)
{
    for (double age : {kInfinity, kNan}) {
        Servo servo;
        servo.pushing({0, 0, 5});
        servo.in.forceAge = age;
        EXPECT_TRUE(servo.tick().did(GovernorAction::stale));
        expectGoneIn20Ticks(servo, "age");
    }
}

// ---- 5: clamp, 6: slew

TEST(ForceGovernor, ALargeForceIsCutTo6NewtonsAndKeepsItsDirection)
{
    Servo servo;
    servo.engaged();
    servo.in.force = {300, -400, 0};

    const GovernorOutput out = servo.ticks(20);

    EXPECT_NEAR(out.force.x, 3.6, kRounding);
    EXPECT_NEAR(out.force.y, -4.8, kRounding);
    EXPECT_TRUE(out.did(GovernorAction::clamped));
    servo.in.force = {1e200, 1e200, 0};
    EXPECT_LE(glm::length(servo.ticks(20).force), 6 + kRounding) << "the length overflows";
    servo.in.force = {std::numeric_limits<double>::max(), 0, 0};
    EXPECT_LE(glm::length(servo.ticks(20).force), 6 + kRounding);
}

TEST(ForceGovernor, AForceChangesByAtMostANewtonPerMillisecond)
{
    Servo servo;
    servo.engaged();
    servo.in.force = {0, 0, 5};
    for (int n = 1; n <= 5; ++n) {
        const GovernorOutput out = servo.tick();
        EXPECT_NEAR(out.force.z, n, kRounding);
        EXPECT_EQ(out.did(GovernorAction::slewed), n < 5);
    }
    glm::dvec3 last = servo.tick().force;
    servo.in.force  = {-4, 3, 0}; // turned as a whole
    for (int n = 0; n < 10; ++n) {
        const glm::dvec3 now = servo.tick().force;
        EXPECT_LE(glm::length(now - last), 1 + kRounding);
        last = now;
    }
    EXPECT_EQ(last, servo.in.force);
}

TEST(ForceGovernor, TheSlewIsPerSecondNotPerTick)
{
    Servo servo;
    servo.engaged();
    servo.in.dt    = 0.5e-3;
    servo.in.force = {0, 0, 5};
    EXPECT_NEAR(servo.ticks(2).force.z, 1, kRounding);
}

// ---- 7: speed

TEST(ForceGovernor, TooFastIsAFaultAndRampsToZeroIn20Milliseconds)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.velocity = {1.2, 0, 0};
    EXPECT_EQ(servo.tick().fault, GovernorFault::none) << "at the limit";

    servo.in.velocity        = {0.9, 0.9, 0}; // 1.27
    const GovernorOutput out = servo.tick();

    EXPECT_EQ(out.fault, GovernorFault::tooFast);
    EXPECT_NEAR(out.force.z, 5 * 0.95, kRounding);
    expectGoneIn20Ticks(servo, "too fast");
}

TEST(ForceGovernor, AHugeSpeedIsTheSameFault)
{
    for (double speed : {1e3, 1e200, std::numeric_limits<double>::max()}) {
        Servo servo;
        servo.pushing({0, 0, 5});
        servo.in.velocity = {speed, speed, -speed};
        servo.in.position = {speed, 0, 0};
        EXPECT_EQ(servo.tick().fault, GovernorFault::tooFast);
        expectGoneIn20Ticks(servo, "huge");
    }
}

TEST(ForceGovernor, AFastHandOnlyRestartsTheWait)
{
    Servo servo;
    servo.in.velocity = {2, 0, 0};
    EXPECT_EQ(servo.ticks(100).fault, GovernorFault::none) << "no force can flow";
    EXPECT_TRUE(servo.tick().did(GovernorAction::waiting));
}

// ---- 8: engagement

TEST(ForceGovernor, NoForceUntilItWasSmallFor10TicksInTheBox)
{
    Servo servo;
    servo.in.force = {0, 0, 3};
    for (int n = 0; n < 5000; ++n) ASSERT_EQ(servo.tick().force, glm::dvec3(0)) << "started inside the object";

    servo.in.force = {0, 0, 0.19};
    servo.ticks(2 + 9); // two of slew, 3 to 1 N; then nine calm ones
    servo.in.inBox = false;
    EXPECT_TRUE(servo.tick().did(GovernorAction::waiting)) << "one outside starts the count again";
    servo.in.inBox = true;
    EXPECT_TRUE(servo.ticks(10).did(GovernorAction::waiting));
    EXPECT_TRUE(servo.tick().did(GovernorAction::engaging));
}

TEST(ForceGovernor, TheForceComesOnEvenlyIn1500Milliseconds)
{
    Servo servo;
    servo.ticks(10);
    servo.in.force = {0, 0, 2};
    servo.ticks(2);
    for (int n = 3; n <= 1500; ++n) EXPECT_NEAR(servo.tick().force.z, 2 * n / 1500.0, 1e-9) << n;
    EXPECT_EQ(servo.tick().gain, 1);
}

// ---- the order

TEST(ForceGovernorOrder, BeliefComesBeforeTheBox)
{
    Servo servo;
    servo.in.homed = servo.in.inBox = false;
    servo.in.force.x                = kNan;
    EXPECT_EQ(servo.tick().fault, GovernorFault::forceNotFinite) << "a NaN is a fault even where it would be zeroed";
}

TEST(ForceGovernorOrder, TheBoxComesBeforePassivity)
{
    Servo servo(strictObserver());
    servo.pushing({0, 0, 1});
    servo.in.position.z      = 1e-3;
    servo.in.velocity.z      = 0.1;
    servo.in.inBox           = false;
    const GovernorOutput out = servo.tick();
    EXPECT_LT(out.energy, 0);
    EXPECT_EQ(out.damping, 0) << "outside not even damping is added";
}

TEST(ForceGovernorOrder, StalenessComesBeforePassivity)
{
    Servo servo(strictObserver());
    servo.pushing({0, 0, 1});
    servo.in.forceAge   = 15e-3; // half
    servo.in.position.z = 20e-6;
    servo.in.velocity.z = 0.1;
    EXPECT_NEAR(servo.tick().force.z, 0.5 - 2 * 0.1, kRounding) << "the damping is not halved";
}

TEST(ForceGovernorOrder, PassivityComesBeforeTheClamp)
{
    Servo servo(strictObserver());
    servo.pushing({0, 0, 6});
    servo.in.position.z      = 2e-3;
    servo.in.velocity.z      = -0.5; // damping of up to 20 N s/m adds 10 N
    const GovernorOutput out = servo.ticks(3);
    EXPECT_TRUE(out.did(GovernorAction::damped));
    EXPECT_TRUE(out.did(GovernorAction::clamped));
    EXPECT_LE(glm::length(out.force), 6 + kRounding);
}

TEST(ForceGovernorOrder, TheClampComesBeforeTheSlew)
{
    Servo servo;
    servo.engaged();
    servo.in.force = {0, 0, 100};
    servo.ticks(50);
    servo.in.force = {};
    EXPECT_NEAR(servo.tick().force.z, 5, kRounding) << "a slew first would have 50 N to come down from";
}

TEST(ForceGovernorOrder, TheSlewComesBeforeTheSpeed)
{
    Servo servo;
    servo.engaged();
    servo.in.force    = {0, 0, 5};
    servo.in.velocity = {2, 0, 0};
    EXPECT_NEAR(servo.tick().force.z, 1 * 0.95, kRounding) << "slewed to 1 N, then the first tick of the ramp";
}

TEST(ForceGovernorOrder, TheSlewComesBeforeTheEngagement)
{
    Servo servo;
    servo.ticks(10 + 750); // half on
    servo.in.force = {0, 0, 5};
    EXPECT_NEAR(servo.tick().force.z, 751 / 1500.0, 1e-9) << "1 N of slew, half of it let through";
}

// ---- the cap, reasons, settings

TEST(ForceGovernor, TheStiffnessCapIsWhatTheArmsDampingBearsWithTheLagOfTheLoop)
{
    GovernorSettings settings;
    settings.maximumStiffness = 5000;
    EXPECT_NEAR(ForceGovernor(settings).stiffnessCap(), 0.8 * 3.2 / 1.5e-3, 1e-9) << "before the first tick";
    const auto cap = [&](double tick, double period, double age) {
        Servo servo(settings);
        servo.in.dt             = tick;
        servo.in.exchangePeriod = period;
        servo.in.answerAge      = age;
        servo.in.sinceAnswer    = period / 2; // what is waited before a tick is not waited after it
        servo.ticks(100);
        return servo.governor.stiffnessCap();
    };
    EXPECT_NEAR(cap(1e-3, 0, 0), 2.56 / 1.5e-3, 1e-9) << "an answer a tick";
    EXPECT_NEAR(cap(2e-3, 0, 0), 2.56 / 3e-3, 1e-9);
    EXPECT_NEAR(cap(1e-3, 1e-3, 1e-3), 2.56 / 2.5e-3, 1e-9);
    EXPECT_NEAR(cap(1e-3, 4e-3, 4e-3), 2.56 / 10e-3, 1e-9) << "the force is held until the next packet";
    EXPECT_NEAR(cap(1e-3, 0.5e-3, 0.5e-3), 2.56 / 1.5e-3, 1e-9) << "the force is held until the next tick";
    EXPECT_EQ(ForceGovernor().stiffnessCap(), 1000) << "the maximum";
}

TEST(ForceGovernor, AForceOfAnOlderPositionIsLagToo)
{
    Servo servo;
    servo.in.forceAge = 2e-3; // a proxy with a thread of its own
    servo.ticks(100);
    EXPECT_NEAR(servo.governor.stiffnessCap(), 2.56 / 3.5e-3, 1e-9);
}

TEST(ForceGovernor, AnArmOfUnknownDampingIsCreditedNothingAndCappedByWhatItsMakerStates)
{
    GovernorSettings settings;
    settings.ownDamping      = 0;
    settings.statedStiffness = 800;
    Servo servo(settings);
    servo.in.answerAge = 5e-3; // whoever states a stiffness has measured it with that age
    servo.ticks(100);
    EXPECT_NEAR(servo.governor.stiffnessCap(), 800, 1e-9);
    EXPECT_EQ(servo.governor.spareDamping(), 0);
    servo.in.exchangePeriod = 3e-3;
    servo.ticks(100);
    EXPECT_NEAR(servo.governor.stiffnessCap(), 800 * 1.5 / 4.5, 1e-9);

    servo.in.answerAge = servo.in.exchangePeriod = 0;
    servo.pushing({0, 0, 1});
    servo.in.velocity = {0.1, 0, 0};
    EXPECT_EQ(servo.tick().energy, 0);
}

TEST(ForceGovernor, WhatTheSpringLeavesOfTheDampingIsSpare)
{
    Servo servo;
    servo.ticks(100);
    EXPECT_NEAR(servo.governor.spareDamping(), 2.56 - 1000 * 1.5e-3, 1e-12);
    servo.in.exchangePeriod = 2e-3;
    servo.in.answerAge      = 2e-3;
    servo.ticks(100);
    EXPECT_NEAR(servo.governor.spareDamping(), 0, 1e-12) << "the cap takes it all";
}

// ---- late ticks

TEST(ForceGovernor, OneLateTickScalesItsOwnForceAndLeavesTheCap)
{
    for (double late : {5e-3, 10e-3, 20e-3, 50e-3}) {
        Servo servo;
        servo.in.stiffness = 866;
        servo.pushing({0, 0, 2});
        servo.in.dt = late;

        const GovernorOutput out = servo.tick();

        EXPECT_NEAR(out.force.z, 2 * 2.56 / (1.5 * late) / 866, kRounding) << "as a loop that is always so late bears";
        EXPECT_TRUE(out.did(GovernorAction::late));
        EXPECT_EQ(servo.governor.stiffnessCap(), 1000) << late;
        servo.in.dt = 1e-3;
        EXPECT_EQ(servo.ticks(2).force.z, 2) << "1 N/ms";
        EXPECT_EQ(servo.tick().actions, 0U);
    }
}

TEST(ForceGovernor, ASoftSpringIsNotScaledByALateTick)
{
    Servo servo;
    servo.in.stiffness = 300; // at 5 ms the arm bears 341
    servo.pushing({0, 0, 2});
    servo.in.dt              = 5e-3;
    const GovernorOutput out = servo.tick();
    EXPECT_EQ(out.force.z, 2);
    EXPECT_EQ(out.actions, 0U);
}

TEST(ForceGovernor, ALoopThatStaysSlowIsCappedWithinATenthOfASecond)
{
    Servo servo;
    servo.ticks(100);
    servo.in.dt = 3e-3;
    servo.ticks(51);
    EXPECT_NEAR(servo.governor.stiffnessCap(), 2.56 / 4.5e-3, 1e-9) << "the median of 100 ticks";
}

TEST(ForceGovernor, ADeviceThatFallsSilentIsScaledWhileItIs)
{
    Servo servo;
    servo.in.stiffness      = 866;
    servo.in.exchangePeriod = 1e-3;
    servo.pushing({0, 0, 2});
    servo.in.sinceAnswer = 8e-3;
    EXPECT_NEAR(servo.ticks(2).force.z, 2 * 2.56 / 12e-3 / 866, kRounding) << "1 N/ms";
    servo.in.sinceAnswer = 0;
    EXPECT_EQ(servo.ticks(2).force.z, 2);
}

TEST(ForceGovernor, EveryFaultHasItsOwnName)
{
    std::set<std::string> names;
    for (int n = 0; n <= 8; ++n) names.insert(name(static_cast<GovernorFault>(n)));
    EXPECT_EQ(names.size(), 9U);
    EXPECT_FALSE(names.contains("unknown"));
}

TEST(ForceGovernor, RefusesSettingsOutOfRangeByName)
{
    const auto complaint = [](auto set) -> std::string {
        GovernorSettings settings;
        set(settings);
        try {
            ForceGovernor governor(settings);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(complaint([](auto& s) { s.maximumForce = 8.1; }).find("maximumForce"), std::string::npos);
    EXPECT_NE(complaint([](auto& s) { s.faultRamp = 0.05; }).find("faultRamp"), std::string::npos);
    EXPECT_NE(complaint([](auto& s) { s.slew = 100; }).find("slew"), std::string::npos) << "8 N would take 80 ms to go";
    EXPECT_NE(complaint([](auto& s) { s.engageTime = kNan; }).find("engageTime"), std::string::npos);
}

TEST(ForceGovernor, TakesEverySettingUpToItsBoundsAndNoneBeyond)
{
    struct Bounds {
        const char* name;
        double GovernorSettings::*field;
        double                    least, most;
    };
    using S                = GovernorSettings;
    const Bounds all[]     = {{"nominalPeriod", &S::nominalPeriod, 1e-5, 1e-2},
                              {"longestTick", &S::longestTick, 1e-5, 2e-2},
                              {"stall", &S::stall, 1e-3, 0.1},
                              {"staleAfter", &S::staleAfter, 0, 0.02},
                              {"staleRamp", &S::staleRamp, 1e-3, 0.02},
                              {"passivitySpeed", &S::passivitySpeed, 0, 0.1},
                              {"passivityDamping", &S::passivityDamping, 0, 20},
                              {"passivityLeak", &S::passivityLeak, 1e-3, 100},
                              {"energyReserve", &S::energyReserve, 0, 0.1},
                              {"energyLimit", &S::energyLimit, 0, 10},
                              {"energyTolerance", &S::energyTolerance, 0, 0.01},
                              {"maximumForce", &S::maximumForce, 0, 8},
                              {"slew", &S::slew, 400, 1e5},
                              {"maximumSpeed", &S::maximumSpeed, 0, 5},
                              {"faultRamp", &S::faultRamp, 1e-3, 0.02},
                              {"calmForce", &S::calmForce, 0, 1},
                              {"engageTime", &S::engageTime, 0.1, 10},
                              {"maximumStiffness", &S::maximumStiffness, 0, 1e4},
                              {"mass", &S::mass, 0, 100},
                              {"ownDamping", &S::ownDamping, 0, 100},
                              {"statedStiffness", &S::statedStiffness, 0, 1e4},
                              {"motorForce", &S::motorForce, 0, 8}};
    const auto   complaint = [](const GovernorSettings& settings) -> std::string {
        try {
            ForceGovernor governor(settings);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    for (const Bounds& one : all) {
        const double beyond = (one.most - one.least) / 1000;
        for (const double value : {one.least, one.most, one.least - beyond, one.most + beyond, kNan}) {
            GovernorSettings settings;
            settings.*one.field = value;
            const bool fits     = value >= one.least && value <= one.most;
            EXPECT_EQ(complaint(settings).find(one.name) == std::string::npos, fits) << one.name << " = " << value;
        }
    }
    for (const int ticks : {0, 1, 20, 21}) {
        GovernorSettings settings;
        settings.missedTicks = ticks;
        EXPECT_EQ(complaint(settings).empty(), ticks >= 1 && ticks <= 20) << ticks;
    }
    for (const int ticks : {0, 1, 1000, 1001}) {
        GovernorSettings settings;
        settings.calmTicks = ticks;
        EXPECT_EQ(complaint(settings).empty(), ticks >= 1 && ticks <= 1000) << ticks;
    }
}

// ---- anything at all

TEST(ForceGovernor, StaysFiniteAndBoundedOnHostileInput)
{
    std::mt19937                           random(11);
    std::uniform_int_distribution<int>     dice(0, 9999);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double rare[]  = {kNan, kInfinity, -kInfinity, std::numeric_limits<double>::max(), -1e300, 1e-310, 5, 0};
    const auto   spoiled = [&](double value) { return dice(random) < 3 ? rare[dice(random) % 8] : value; };

    Servo servo;
    int   faults = 0, afterFault = 0, flowing = 0;
    for (int n = 0; n < 1000000; ++n) {
        GovernorInput& in = servo.in;
        for (int axis = 0; axis < 3; ++axis) {
            in.force[axis]    = spoiled(n % 4000 < 2500 ? 0 : 8 * unit(random));
            in.position[axis] = spoiled(0.001 * unit(random));
            in.velocity[axis] = spoiled(0.2 * unit(random));
        }
        in.dt              = spoiled(1e-3 * (1 + 0.5 * unit(random)));
        in.exchangePeriod  = spoiled(1e-3);
        in.answerAge       = spoiled(1e-3);
        in.sinceAnswer     = spoiled(1e-3);
        in.stiffness       = spoiled(800);
        in.forceAge        = spoiled(5e-3 * std::abs(unit(random)));
        in.admittedEnergy  = spoiled(1e-6);
        in.storedEnergy    = spoiled(1e-3);
        in.homed           = dice(random) > 0;
        in.inBox           = dice(random) > 0;
        in.missedExchanges = dice(random) == 0 ? 1000000 : 0;

        const GovernorOutput out = servo.tick();

        ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z) && std::isfinite(out.energy) &&
                    std::isfinite(out.damping) && std::isfinite(out.gain) &&
                    std::isfinite(servo.governor.stiffnessCap()));
        ASSERT_LE(glm::length(out.force), 6 + kRounding);
        flowing += out.force != glm::dvec3(0);
        afterFault = out.fault == GovernorFault::none ? 0 : afterFault + 1;
        if (afterFault > 45) {
            ASSERT_EQ(out.force, glm::dvec3(0));
        } // ticks of 0.5 ms take 40 for 20 ms
        if (afterFault == 60) {
            servo.governor.reset();
            ++faults;
        }
    }
    EXPECT_GT(faults, 100) << "or the test says nothing";
    EXPECT_GT(flowing, 1000) << "or the test says nothing";
}

} // namespace
} // namespace palp
