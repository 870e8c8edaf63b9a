// Tests of the force that carries the arm: when it flows, how it comes and goes, and that nothing else notices it.
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/contract.h"
#include "tests/force/governor_servo.h"

namespace palp {
namespace {

constexpr double kWeight = 2.06; // [N] of 0.21 kg

GovernorSettings heavy()
{
    GovernorSettings settings;
    settings.weight = {0, -kWeight, 0};
    return settings;
}

double toMotors(const Servo& servo)
{
    return glm::length(servo.governor.force().newtons());
}

TEST(GovernorWeight, IsCarriedGraduallyAndThenWhole)
{
    Servo  servo(heavy());
    double last = 0, step = 0; // [N]
    for (int n = 0; n < 1600; ++n) {
        servo.tick();
        step = std::max(step, std::abs(toMotors(servo) - last));
        last = toMotors(servo);
    }
    EXPECT_EQ(servo.governor.force().newtons(), glm::dvec3(0, kWeight, 0));
    EXPECT_LE(step, kWeight / 1500 + kRounding) << "1.5 s from nothing to all";
    EXPECT_EQ(servo.tick().force, glm::dvec3(0)) << "the hand feels nothing of it";
}

/// Uncarried the arm lies in the object, and its force is never calm.
TEST(GovernorWeight, DoesNotWaitForACalmHand)
{
    Servo servo(heavy());
    servo.in.force           = {0, 1, 0};
    const GovernorOutput out = servo.ticks(2000);
    EXPECT_TRUE(out.did(GovernorAction::waiting));
    EXPECT_EQ(out.force, glm::dvec3(0));
    EXPECT_EQ(servo.governor.force().newtons(), glm::dvec3(0, kWeight, 0));
}

struct Failure {
    const char*                         name;
    std::function<void(GovernorInput&)> cause;
    int                                 notices = 0; ///< ticks that the governor allows first
};

std::vector<Failure> failures()
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {{"a force that is not finite", [nan](GovernorInput& in) { in.force.x = nan; }},
            {"a place that is not finite", [nan](GovernorInput& in) { in.position.y = nan; }},
            {"a speed that is not finite", [](GovernorInput& in) { in.velocity.z = kInfinity; }},
            {"a clock that is not finite", [nan](GovernorInput& in) { in.dt = nan; }},
            {"a clock that stopped", [](GovernorInput& in) { in.dt = 0; }, 20},
            {"a loop that stalled", [](GovernorInput& in) { in.dt = 0.2; }},
            {"a device that is lost", [](GovernorInput& in) { in.missedExchanges = 21; }},
            {"too fast", [](GovernorInput& in) { in.velocity.x = 1.3; }},
            {"not homed", [](GovernorInput& in) { in.homed = false; }},
            {"out of the box", [](GovernorInput& in) { in.inBox = false; }},
            {"a force that is 30 ms old", [](GovernorInput& in) { in.forceAge = 0.03; }},
            {"a table that is too old", [](GovernorInput& in) { in.overdue = 0.03; }}};
}

/// With a force on the hand and in free space: at the motors nothing is left after 20 ms, and nothing jumps.
TEST(GovernorWeight, IsGoneWithin20MillisecondsOfEveryFailure)
{
    for (const Failure& failure : failures())
        for (const double felt : {0.0, 3.0}) {
            Servo servo(heavy());
            servo.engaged();
            servo.in.force = {0, felt, 0};
            servo.ticks(20);
            ASSERT_NEAR(toMotors(servo), kWeight + felt, kRounding) << failure.name;

            failure.cause(servo.in);
            servo.ticks(failure.notices);
            double last = toMotors(servo);
            for (int n = 0; n < 20; ++n) {
                servo.tick();
                const double now = toMotors(servo);
                // 1 N a tick is the governor's slew; a fault, and the weight in any case, go by a twentieth. A tick of
                // 0.2 s takes all.
                if (servo.in.dt == 1e-3) {
                    EXPECT_LE(last - now, kWeight / 20 + (felt > 0 ? 1 + felt / 20 : 0) + kRounding) << failure.name;
                }
                EXPECT_LE(now, last + kRounding) << failure.name;
                last = now;
            }
            EXPECT_EQ(last, 0) << failure.name << ", felt " << felt << " N";
        }
}

TEST(GovernorWeight, ComesOnAnewWhenTheFailureIsOver)
{
    Servo servo(heavy());
    servo.engaged();
    servo.in.inBox = false;
    servo.ticks(30);
    servo.in.inBox = true;
    servo.tick();
    EXPECT_EQ(toMotors(servo), 0) << "ten good ticks first";
    servo.ticks(10);
    EXPECT_LT(toMotors(servo), 0.01);
    servo.ticks(1500);
    EXPECT_NEAR(toMotors(servo), kWeight, kRounding);
}

/// The observer, the limits and the stiffness are as without it, to the bit.
TEST(GovernorWeight, NothingElseNoticesIt)
{
    Servo with(heavy()), without;
    for (Servo* servo : {&with, &without}) servo->engaged();
    for (int n = 0; n < 500; ++n) {
        for (Servo* servo : {&with, &without}) {
            servo->in.force    = {0, 4 * std::sin(0.1 * n), 0};
            servo->in.velocity = {0, 0.2 * std::cos(0.1 * n), 0};
            servo->in.position = {0, 2e-3 * std::sin(0.1 * n), 0};
        }
        const GovernorOutput one = with.tick(), other = without.tick();
        ASSERT_EQ(one.force, other.force) << n;
        ASSERT_EQ(one.energy, other.energy) << n;
        ASSERT_EQ(one.actions, other.actions) << n;
    }
}

TEST(GovernorWeight, TheMotorsGetNoMoreThanTheyHold)
{
    GovernorSettings settings = heavy();
    settings.motorForce       = 5;
    Servo servo(settings);
    servo.engaged();
    servo.in.force           = {0, 6, 0};
    const GovernorOutput out = servo.ticks(20);
    EXPECT_NEAR(toMotors(servo), 5, kRounding);
    EXPECT_NEAR(out.force.y, 5 - kWeight, kRounding) << "what is felt of it";
    EXPECT_TRUE(out.did(GovernorAction::clamped));
}

TEST(GovernorWeight, AnArmThatNoMotorCarriesIsRefused)
{
    GovernorSettings settings;
    settings.weight = {0, -5, 0};
    EXPECT_THROW(ForceGovernor{settings}, Error);
    settings.weight = {0, std::numeric_limits<double>::quiet_NaN(), 0};
    EXPECT_THROW(ForceGovernor{settings}, Error);
}

/// A hand that moves fast by itself meets no force, so nobody has to press a button.
TEST(ForceGovernor, AFastHandInFreeSpaceEngagesAnewByItself)
{
    Servo servo;
    servo.engaged();
    servo.ticks(60); // no force for longer than a velocity is old
    servo.in.velocity = {1.5, 0, 0};
    EXPECT_EQ(servo.ticks(10).fault, GovernorFault::none);
    EXPECT_TRUE(servo.tick().did(GovernorAction::waiting));
    servo.in.force = {0, 0, 3}; // it flies into the object
    EXPECT_EQ(servo.ticks(100).force, glm::dvec3(0));
    servo.in.velocity = {};
    servo.in.force    = {};
    servo.engaged();
    EXPECT_EQ(servo.governor.fault(), GovernorFault::none);
}

TEST(ForceGovernor, AHandIsFastByItselfOnceNoForceActedForFiftyMilliseconds)
{
    for (const auto& [ticks, fault] : {std::pair{48, GovernorFault::tooFast}, {52, GovernorFault::none}}) {
        Servo servo;
        servo.pushing({0, 0, 5});
        servo.in.force = {};
        while (servo.tick().force != glm::dvec3(0)) {
        } // a tick without a force is one of them
        servo.ticks(ticks - 1);
        servo.in.velocity = {0, 0, 1.5};
        EXPECT_EQ(servo.tick().fault, fault) << ticks << " ms";
    }
}

TEST(ForceGovernor, AHandThatAForceHasJustDrivenIsAFault)
{
    Servo servo;
    servo.pushing({0, 0, 5});
    servo.in.force = {};
    servo.ticks(20); // off the surface, and the filtered speed comes later
    servo.in.velocity = {0, 0, 1.5};
    EXPECT_EQ(servo.tick().fault, GovernorFault::tooFast);
}

} // namespace
} // namespace palp
