// Step 4 of the governor: what the observer counts, and what the controller takes back.
#include <algorithm>
#include <cmath>

#include "tests/force/governor_servo.h"

namespace palp {
namespace {

TEST(ForceGovernor, TheEnergyIsTheWorkOfTheForceThatActed)
{
    for (int delay : {0, 1, 3}) {
        Servo servo(strictObserver());
        servo.in.exchangePeriod = std::max(1, delay) * 1e-3;
        servo.in.sinceAnswer    = delay == 0 ? 1e-3 : 0; // the next packet leaves now
        servo.pushing({0, 0, 2});

        servo.in.position.z = -1e-3; // the hand goes in against 2 N
        servo.in.force.z    = 1;
        EXPECT_NEAR(servo.tick().energy, 2e-3, 1e-15) << "1 N is sent only now";
        const int later = delay + (delay == 0 ? 1 : 0); // the position of the next tick is still of before
        for (int n = 0; n < later; ++n) EXPECT_NEAR(servo.tick().energy, 2e-3, 1e-15) << "nothing moved";
        servo.in.position.z = 0;
        EXPECT_NEAR(servo.tick().energy, 1e-3, 1e-15) << "1 N acts, delay " << delay;
    }
}

TEST(ForceGovernor, APositionIsOfTheTimeAtWhichItWasMeasured)
{
    Servo servo(strictObserver());
    servo.in.exchangePeriod = 1e-3;
    servo.in.answerAge      = 2e-3;
    servo.pushing({0, 0, 2});
    servo.in.force.z = 1;
    servo.ticks(3); // 1 N has acted for a tick, but not yet where the position comes from
    servo.in.position.z = -1e-3;
    EXPECT_NEAR(servo.tick().energy, 2e-3, 1e-15);
    servo.in.position.z = 0;
    EXPECT_NEAR(servo.tick().energy, 1e-3, 1e-15);
}

TEST(ForceGovernor, TheForceThatActedWhileAnAnswerWasAwaitedIsAMean)
{
    Servo servo(strictObserver());
    servo.in.exchangePeriod = 1e-3;
    servo.pushing({0, 0, 2});
    servo.in.force.z     = 1;
    servo.in.sinceAnswer = 1e-3;
    servo.tick(); // no answer this time; 1 N acts at once
    servo.in.sinceAnswer = 0;
    servo.in.position.z  = -1e-3;
    EXPECT_NEAR(servo.tick().energy, 1.5e-3, 1e-12) << "2 N for a tick, then 1 N for a tick";
}

/// A clock that stands still while the places are older than what is remembered: no time, no work.
TEST(ForceGovernor, InNoTimeAtAllNoWorkIsDone)
{
    Servo servo(strictObserver());
    servo.pushing({0, 0, 2});
    servo.in.sinceAnswer = servo.in.answerAge = 0.05;
    const double before                       = servo.ticks(200).energy;
    servo.in.dt                               = 0;
    servo.in.position.z                       = -1e-3;
    EXPECT_NEAR(servo.tick().energy, before, 1e-12);
}

TEST(ForceGovernor, TheTanksEnergyAndTheArmsDampingAreCredited)
{
    Servo servo;
    servo.pushing({0, 0, 1});
    servo.in.admittedEnergy = 0.4e-3;
    servo.in.velocity       = {0.1, 0, 0};

    EXPECT_NEAR(servo.tick().energy, 0.4e-3 + 1.5 * 0.01 * 1e-3, 1e-15);
}

TEST(ForceGovernor, DissipatedEnergyIsForgotten)
{
    // 10 s of sliding against 1 N would leave 1 J behind which any amount of activity could hide.
    Servo servo;
    servo.pushing({1, 0, 0});
    servo.in.storedEnergy = 3e-3;
    servo.in.velocity     = {-0.1, 0, 0};
    GovernorOutput out;
    for (int n = 1; n <= 10000; ++n) {
        servo.in.position.x = -1e-4 * n;
        out                 = servo.tick();
    }
    EXPECT_NEAR(out.energy, 3e-3 + 2e-3, 1e-15) << "what is stored and the reserve";

    servo.in.storedEnergy = kInfinity;
    for (int n = 1; n <= 10000; ++n) {
        servo.in.position.x = -1 - 1e-4 * n;
        out                 = servo.tick();
    }
    EXPECT_EQ(out.energy, 0.2) << "unknown: the limit";
}

TEST(ForceGovernor, EnergyIsForgottenOutOfContactWithinASecond)
{
    Servo servo(strictObserver());
    servo.pushing({0, 0, 2});
    servo.in.position.z = -1e-3;
    servo.tick();
    servo.in.force = {};
    servo.ticks(3);
    const double before = servo.tick().energy;

    EXPECT_NEAR(servo.ticks(1000).energy / before, std::exp(-1), 1e-3) << "leak of 1 s in steps of 1 ms";
}

TEST(ForceGovernor, TheControllerTakesBackWhatWasGenerated)
{
    Servo servo(strictObserver());
    servo.pushing({0, 0, 1});
    servo.in.position.z = 20e-6; // 1 N along 20 um: 20 uJ out of nothing
    servo.in.velocity.z = 0.1;

    const GovernorOutput out = servo.tick();

    EXPECT_NEAR(out.energy, -20e-6, 1e-15);
    EXPECT_NEAR(out.damping, 20e-6 / (0.01 * 1e-3), 1e-9) << "-E / (v^2 T)";
    EXPECT_NEAR(out.force.z, 1 - 2 * 0.1, kRounding);
    EXPECT_TRUE(out.did(GovernorAction::damped));
    EXPECT_FALSE(out.did(GovernorAction::active)) << "below the tolerance";
}

TEST(ForceGovernor, TheControllerStopsAtItsLargestDampingAndBelowItsSpeed)
{
    Servo servo(strictObserver());
    servo.pushing({0, 0, 1});
    servo.in.position.z       = 1e-3;
    servo.in.velocity.z       = 0.009;
    const GovernorOutput slow = servo.tick();
    EXPECT_EQ(slow.damping, 0);
    EXPECT_TRUE(slow.did(GovernorAction::active)) << "1 mJ is beyond the tolerance";

    servo.in.velocity.z = 0.02;
    EXPECT_EQ(servo.tick().damping, 20);
}

/// A wall that pushes along the velocity with 8 N s/m, on an arm of 0.46 kg and 3.2 N s/m: it would run away.
double speedOfPushedMass(const GovernorSettings& settings)
{
    Servo servo(settings);
    servo.engaged();
    double x = 0, v = 0.05, fastest = 0;
    for (int n = 0; n < 3000 && servo.governor.fault() == GovernorFault::none; ++n) {
        servo.in.position.x = x;
        servo.in.velocity.x = v;
        servo.in.force      = {8 * v, 0, 0};
        v += (servo.tick().force.x - 3.2 * v) / 0.46 * 1e-3;
        x += v * 1e-3;
        fastest = std::max(fastest, std::abs(v));
    }
    return fastest;
}

TEST(ForceGovernor, AnActiveWallIsHeldByTheControllerOnly)
{
    GovernorSettings without;
    without.passivityDamping = 0;
    EXPECT_GT(speedOfPushedMass(without), 1.2) << "the test must bite";
    EXPECT_LE(speedOfPushedMass({}), 0.052) << "what the first ticks add";
}

/// A lifted finger takes the surface's last energy with it; damping it further would glue it on.
TEST(ForceGovernor, TheControllerNeverTurnsAForceRound)
{
    Servo servo;
    servo.engaged();
    GovernorOutput out;
    for (int n = 0; n < 200; ++n) { // out at 0.1 m/s, while the force gives energy that nobody put in
        servo.in.velocity = {0, 0, 0.1};
        servo.in.position += servo.in.velocity * 1e-3;
        servo.in.force = {0, 0, n < 100 ? 0.2 : 0.0};
        out            = servo.tick();
        EXPECT_GE(out.force.z, 0) << n;
    }
    EXPECT_TRUE(out.energy < 0 || out.force.z == 0);
}

} // namespace
} // namespace palp
