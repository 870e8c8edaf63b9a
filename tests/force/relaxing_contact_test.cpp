#include "engine/force/relaxing_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <type_traits>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/errors.h"

namespace palp {
namespace {

constexpr double kDt = 1e-3, kFade = 4e-3; // [s], [m]
constexpr double kK = 500;                 // [N/m]

static_assert(std::is_trivially_copyable_v<RelaxingContact>, "it owns nothing, so it cannot allocate");
static_assert(noexcept(std::declval<RelaxingContact&>().step({})));

Relaxation meat()
{
    return {{{{0.26, 0.41}, {0.31, 4.3}}}, 2};
}

/// What is left of a force after a time [1].
double left(const Relaxation& relaxation, double time)
{
    double share = 1;
    for (std::size_t n = 0; n < relaxation.count; ++n)
        share -= relaxation.terms[n].share * (1 - std::exp(-time / relaxation.terms[n].time));
    return share;
}

TEST(RelaxingContact, AStepDiesAwayByThePronySeries)
{
    RelaxingContact contact(meat(), kFade);
    const DepthLaw  law{kK, 810, 2000};
    EXPECT_NEAR(contact.step({law, 2e-3, {}, 0}).force, law.force(2e-3), 1e-12) << "at once it is elastic";

    double worst = 0;
    for (int n = 1; n <= 10'000; ++n) {
        const double force = contact.step({law, 2e-3, {}, kDt}).force;
        worst              = worse(worst, force / (law.force(2e-3) * left(meat(), n * kDt)) - 1);
    }
    EXPECT_LT(worst, 1e-9) << "ten thousand roundings of a logarithm and an exponential";
    EXPECT_EQ(contact.surface(), 2e-3);
}

TEST(RelaxingContact, ARampAndAHoldAreTheirClosedForms)
{
    RelaxingContact  contact(meat(), kFade);
    const DepthLaw   law{kK};
    constexpr double kSpeed = 5e-3, kRamp = 0.4; // [m/s], [s]
    const auto       ramp = [](double t) {       // force of a ramp that began t ago
        double force = 0;
        if (t <= 0) return force;
        force = kK * kSpeed * t;
        for (std::size_t n = 0; n < 2; ++n) {
                  const auto [share, time] = meat().terms[n];
                  force -= share * kK * kSpeed * (t - time * -std::expm1(-t / time));
        }
        return force;
    };
    for (int n = 1; n <= 3000; ++n) {
        const double t = n * kDt;
        EXPECT_NEAR(contact.step({law, kSpeed * std::min(t, kRamp), {}, kDt}).force, ramp(t) - ramp(t - kRamp), 1e-10)
            << t << ": a tick is solved as a ramp, so nothing but rounding is left";
    }
}

TEST(RelaxingContact, StorageAndLossOfASineAreTheirClosedForms)
{
    for (const double frequency : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0}) {
        RelaxingContact  contact(meat(), kFade);
        const double     w     = 2 * std::numbers::pi * frequency;
        constexpr double kMean = 3e-3, kSwing = 0.3e-3; // [m] never lifts
        const int        settle = int(30 / kDt), whole = int(std::llround(std::max(1.0, frequency) / frequency / kDt));
        double           inPhase = 0, ahead = 0;
        for (int n = 1; n <= settle + whole; ++n) {
            const double phase = w * n * kDt;
            const double force = contact.step({{kK}, kMean + kSwing * std::sin(phase), {}, kDt}).force;
            if (n <= settle) continue;
            inPhase += 2 * force * std::sin(phase) / whole / kSwing;
            ahead += 2 * force * std::cos(phase) / whole / kSwing;
        }
        double storage = kK, loss = 0;
        for (std::size_t n = 0; n < 2; ++n) {
            const auto [share, time] = meat().terms[n];
            storage -= share * kK / (1 + w * w * time * time);
            loss += share * kK * w * time / (1 + w * w * time * time);
        }
        EXPECT_NEAR(inPhase / storage, 1, 0.01) << frequency << " Hz: a millisecond's chord of a sine";
        EXPECT_NEAR(ahead / loss, 1, 0.01) << frequency << " Hz";
    }
}

/// The work of a hand, by the trapezoid of the way on which it touches the surface.
struct Work {
    double done = 0, most = 0, depth = 0, force = 0, surface = 0; // [J] by the hand, [J] most stored, [m], [N], [m]

    void take(double newDepth, const RelaxingContact::Output& out, double newSurface)
    {
        const double from = force > 0 ? depth : std::max(depth, surface);
        const double to   = out.force > 0 ? newDepth : std::max(newDepth, newSurface);
        done += (force + out.force) / 2 * (to - from);
        depth   = newDepth;
        force   = out.force;
        surface = newSurface;
        most    = std::max(most, out.stored);
    }
};

/// Presses slowly, slides to fresh material and lifts at once.
double pressSlideLift(double fade)
{
    RelaxingContact contact({{{{0.6, 0.05}}}, 1}, fade);
    Work            work;
    const auto      run = [&](double to, double place, double seconds) {
        const int    ticks = std::max(1, int(seconds / kDt));
        const double from  = work.depth;
        for (int n = 1; n <= ticks; ++n) {
            const double depth = from + (to - from) * n / ticks;
            const auto   out   = contact.step({{kK}, depth, {place, 0, 0}, kDt});
            work.take(depth, out, contact.surface());
        }
    };
    run(3e-3, 0, 2);
    for (int n = 0; n < 200; ++n) run(3e-3, n * 1e-3, kDt);
    run(0, 0.2, 2e-3);
    return work.done;
}

TEST(RelaxingContact, FreshMaterialUnderASlidingFingerIsPaidByWhatWasLost)
{
    // Pressed slowly it costs (1 - g) K d^2 / 2 = 0.9 mJ and what is lost; lifted fast from fresh material it would
    // give back K d^2 / 2 = 2.25 mJ.
    EXPECT_GE(pressSlideLift(kFade), 0);
    EXPECT_LT(pressSlideLift(kFade), 0.5e-3) << "or nothing faded";
}

TEST(RelaxingContact, NoClosedStrokeGivesEnergyToTheHand)
{
    std::mt19937                           random(21);
    std::uniform_real_distribution<double> share(0, 1);
    const auto between = [&](double low, double high) { return low + (high - low) * share(random); };
    double     worst = 1, slid = 0;
    for (int stroke = 0; stroke < 10'000; ++stroke) {
        Relaxation relaxation;
        relaxation.count = 1 + std::size_t(between(0, 3));
        for (std::size_t n = 0; n < relaxation.count; ++n)
            relaxation.terms[n] = {between(0.05, 0.32), std::exp(between(std::log(0.01), std::log(5)))};
        const DepthLaw  law = DepthLaw::capped(between(50, 1000), stroke % 2 == 0 ? 0 : between(1, 2000), 1000);
        RelaxingContact contact(relaxation, kFade);
        Work            work;
        double          place = 0;
        const int       legs  = 3 + int(between(0, 5));
        for (int leg = 0; leg <= legs; ++leg) {
            const auto   kind = int(between(0, 4)); // press or lift, hold, slide, both
            const double to   = leg == legs ? -1e-3 : kind == 0 || kind == 3 ? between(-1e-3, 5e-3) : work.depth;
            const double way = kind >= 2 ? between(-20e-3, 20e-3) : 0, from = work.depth, begin = place;
            // At most 0.1 m/s, as hands press: a trapezoid of more of the exponential is not its work.
            const int ticks = int(std::abs(to - from) / 0.1e-3) + 1 + int(std::exp(between(0, std::log(200))));
            for (int n = 1; n <= ticks; ++n) {
                place              = begin + way * n / ticks;
                const double depth = from + (to - from) * n / ticks;
                const auto   out   = contact.step({law, depth, {place, 0, 0}, kDt});
                ASSERT_GE(out.force, 0) << "a surface never pulls";
                slid += out.refreshed;
                work.take(depth, out, contact.surface());
            }
        }
        worst = std::min(worst, work.done);
    }
    std::printf("  least work of a closed stroke %.1e J; %.2f J made fresh\n", worst, slid);
    EXPECT_GT(worst, -2e-7) << "J: a trapezoid of 0.1 mm at the cap stores 5e-6 J, and errs by b dx / 12 of it at most";
    EXPECT_GT(slid, 1) << "or sliding was never paid for";
}

TEST(RelaxingContact, SteadySlidingIsBetweenFreshAndRelaxed)
{
    const Relaxation relaxation{{{{0.5, 0.2}}}, 1};
    for (const double speed : {0.005, 0.02, 0.1}) {
        RelaxingContact contact(relaxation, kFade);
        double          force = 0;
        for (int n = 0; n < 4000; ++n) force = contact.step({{kK}, 2e-3, {speed * n * kDt, 0, 0}, kDt}).force;
        // m' = (F_e - m) / tau - m v / R = 0
        EXPECT_NEAR(force / (kK * 2e-3), 1 - 0.5 / (1 + speed * 0.2 / kFade), 0.01) << "fading goes by ticks";
    }
}

TEST(RelaxingContact, ATremblingFingerStaysAtItsPlace)
{
    RelaxingContact contact(meat(), kFade);
    double          force = 0;
    for (int n = 0; n < 2000; ++n) force = contact.step({{kK}, 2e-3, {n % 2 * 0.1e-3, 0, 0}, kDt}).force;
    EXPECT_NEAR(force / (kK * 2e-3), left(meat(), 2), 1e-3) << "half a tick of the first ramp";
}

TEST(RelaxingContact, ASurfaceThatIsLeftStaysBehindAndComesUpAgain)
{
    RelaxingContact contact(meat(), kFade);
    for (int n = 0; n < 5000; ++n) static_cast<void>(contact.step({{kK}, 2e-3, {}, kDt}));
    EXPECT_EQ(contact.step({{kK}, 0, {}, kDt}).force, 0);
    const double after = contact.surface();
    EXPECT_GT(after, 0.2 * 2e-3) << "what got used to the dent";
    EXPECT_LT(after, 0.57 * 2e-3) << "at most the sum of the shares";
    EXPECT_EQ(contact.step({{kK}, after / 2, {}, kDt}).force, 0) << "the finger is not there yet";
    EXPECT_GT(contact.step({{kK}, after, {}, kDt}).force, 0);
    for (int n = 0; n < 40'000; ++n) static_cast<void>(contact.step({{kK}, 0, {}, kDt}));
    EXPECT_LT(contact.surface(), 0.01 * after) << "e^-7 of it, with the time of a free surface";
}

TEST(RelaxingContact, ASurfaceThatIsLeftComesUpTheSameWayInTicksOfAnyLength)
{
    const auto surfaceAfter = [](double dt) {
        RelaxingContact contact(meat(), kFade);
        for (int n = 0; n < 2000; ++n) static_cast<void>(contact.step({{kK}, 2e-3, {}, kDt}));
        for (int n = 0; n < std::lround(0.4 / dt); ++n) static_cast<void>(contact.step({{kK}, 0, {}, dt}));
        return contact.surface();
    };
    const double fine = surfaceAfter(0.25e-3);
    EXPECT_GT(fine, 0.1e-3);
    // The force runs straight within a tick, which errs by its square; it jumps only when the hand goes.
    EXPECT_NEAR(surfaceAfter(1e-3), fine, 2e-3 * fine);
    EXPECT_NEAR(surfaceAfter(4e-3), fine, 8e-3 * fine);
}

TEST(RelaxingContact, AHandThatWasLiftedAndMovesALittleStillFindsTheDent)
{
    RelaxingContact contact(meat(), kFade);
    for (int n = 0; n < 5000; ++n) static_cast<void>(contact.step({{kK}, 2e-3, {}, kDt}));
    static_cast<void>(contact.step({{kK}, 0, {}, kDt}));
    const double left = contact.surface();
    static_cast<void>(contact.step({{kK}, 0, {0.3e-3, 0, 0}, kDt})); // 0.05 mm beyond what counts as the same place
    EXPECT_NEAR(contact.surface(), std::exp(-0.05 / 4) * left, 0.01 * left) << "and a tick of coming up, 0.3 %";
    static_cast<void>(contact.step({{kK}, 0, {0.05, 0, 0}, kDt}));
    EXPECT_LT(contact.surface(), 1e-3 * left) << "elsewhere nothing was pressed";
}

TEST(RelaxingContact, WhatIsNotFiniteForgetsEverything)
{
    using Tick      = RelaxingContact::Tick;
    const Tick good = {{kK, 300, 2000}, 2e-3, {}, kDt};
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (int field = 0; field < 7; ++field) {
            RelaxingContact contact(meat(), kFade), fresh(meat(), kFade);
            for (int n = 0; n < 2000; ++n) static_cast<void>(contact.step(good));
            Tick    now    = good;
            double* all[]  = {&now.depth,         &now.dt, &now.place.x, &now.place.y, &now.place.z, &now.law.stiffness,
                              &now.law.stiffening};
            *all[field]    = bad;
            const auto out = contact.step(now);
            EXPECT_EQ(out.force, 0) << field;
            EXPECT_EQ(out.stored, 0) << field;
            EXPECT_EQ(contact.surface(), 0) << field;
            EXPECT_EQ(contact.step(good).force, fresh.step(good).force) << field;
        }
}

/// What an earlier touch lost is gone: it does not pay for fresh material in a later one.
TEST(RelaxingContact, OnlyWhatThisContactLostPaysForFreshMaterial)
{
    const auto refreshedAfter = [](const std::optional<RelaxingContact::Tick>& between) {
        RelaxingContact contact(meat(), kFade);
        for (int n = 0; n < 2000; ++n) static_cast<void>(contact.step({{kK}, 2e-3, {}, kDt}));
        if (between) static_cast<void>(contact.step(*between));
        static_cast<void>(contact.step({{kK}, 2e-3, {}, kDt}));
        return contact.step({{kK}, 2e-3, {5e-3, 0, 0}, kDt}).refreshed;
    };
    const double one = refreshedAfter(std::nullopt);
    EXPECT_GT(one, 0.05e-3) << "a tenth of the millijoule that is pressed in";
    EXPECT_LT(refreshedAfter({{{kK}, 0, {}, kDt}}), 0.1 * one) << "a hand that was lifted";
    EXPECT_LT(refreshedAfter({{{0}, 0, {}, kDt}}), 0.1 * one) << "where nothing was known, likewise";
}

/// Within a tick what is lost a second only grows or falls: the lesser end bounds it, so that no more is given back.
TEST(RelaxingContact, ATickCountsNoMoreAsLostThanItsLesserEnd)
{
    RelaxingContact contact(meat(), kFade);
    EXPECT_EQ(contact.step({{kK}, 0.2e-3, {}, kDt}).refreshed, 0) << "nothing slid";
    EXPECT_EQ(contact.step({{kK}, 2e-3, {}, kDt}).refreshed, 0);
    double lost = 0; // [J] at most, by the first end of the second tick
    for (std::size_t n = 0; n < 2; ++n)
        lost += meat().terms[n].share / meat().terms[n].time * kDt * kK * 0.2e-3 * 0.2e-3;
    EXPECT_LE(contact.step({{kK}, 2e-3, {5e-3, 0, 0}, kDt}).refreshed, lost);
}

/// As between two objects, or where a map has a hole.
TEST(RelaxingContact, WhereNoStiffnessIsKnownTheMemoryWaitsWithoutAForce)
{
    RelaxingContact contact(meat(), kFade);
    double          force = 0;
    for (int n = 0; n < 2000; ++n) force = contact.step({{kK}, 2e-3, {}, kDt}).force;
    ASSERT_GT(force, 0.1);
    for (int n = 0; n < 500; ++n) {
        const auto out = contact.step({{0}, 2e-3, {}, kDt});
        ASSERT_EQ(out.force, 0);
        ASSERT_EQ(out.stored, 0);
    }
    EXPECT_NEAR(contact.step({{kK}, 2e-3, {}, 0}).force, force, 1e-12);
}

TEST(RelaxingContact, ChangesWithTheStiffnessAsASpringDoes)
{
    RelaxingContact contact(meat(), kFade);
    for (int n = 0; n < 500; ++n) static_cast<void>(contact.step({{kK}, 2e-3, {}, kDt}));
    RelaxingContact stiffer = contact;
    const auto      one = contact.step({{kK}, 2e-3, {}, 0}), two = stiffer.step({{2 * kK}, 2e-3, {}, 0});
    EXPECT_NEAR(two.force / one.force, 2, 1e-9);
    EXPECT_NEAR(two.stored / one.stored, 2, 1e-9);
}

/// Returns whether an arm that rests on the contact swings up or comes to rest: a force a tick late, held for a tick.
bool settles(const Relaxation& relaxation, double stiffness)
{
    constexpr double kMass = 0.46, kDamping = 3.2, kPush = 1, kStep = 1e-5; // [kg], [N s/m], [N], [s]
    RelaxingContact  contact(relaxation, kFade);
    double           depth = kPush / stiffness + 0.05e-3, speed = 0, late = kPush, early = 0, end = 0; // [m], [m/s]
    for (int n = 0; n < 1500; ++n) {
        const double force = std::exchange(late, contact.step({{stiffness}, depth, {}, kDt}).force);
        for (int m = 0; m < int(kDt / kStep); ++m) {
            speed += (kPush - force - kDamping * speed) / kMass * kStep;
            depth += speed * kStep;
        }
        if (n >= 100 && n < 300) early = std::max(early, std::abs(speed));
        if (n >= 1300) end = worse(end, speed);
    }
    return end < early;
}

double stiffestThatSettles(const Relaxation& relaxation)
{
    double calm = 300, swings = 6000; // [N/m]
    while (swings - calm > 5) {
        const double middle                           = (calm + swings) / 2;
        (settles(relaxation, middle) ? calm : swings) = middle;
    }
    return calm;
}

TEST(RelaxingContact, AnArmOnItIsStableUpToNoLessThanOnASpring)
{
    const double spring = stiffestThatSettles({});
    EXPECT_NEAR(spring, 3.2 / 1.5e-3, 0.1 * 3.2 / 1.5e-3) << "b over the lag of a tick and a half";
    for (const Relaxation& relaxation : {meat(), Relaxation{{{{0.5, 0.02}}}, 1}, Relaxation{{{{0.3, 2e-3}}}, 1}}) {
        const double relaxing = stiffestThatSettles(relaxation);
        std::printf("  a spring %.0f N/m, relaxing by %.2f in %.3f s %.0f N/m\n", spring, relaxation.terms[0].share,
                    relaxation.terms[0].time, relaxing);
        EXPECT_GE(relaxing, spring - 5) << "the search's step";
    }
}

} // namespace
} // namespace palp
