#include "engine/force/compliance_tracker.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/allocations.h"
#include "tests/support/published_tables.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3; // [s]

/// ln c = value + slope x on 3 x 3 footprints 4 mm apart, k_c = 1000 N/m.
ComplianceTable tableOf(std::uint64_t sequence, double value, double slope = 0, double time = 0)
{
    ComplianceTable table;
    table.sequence = sequence;
    table.time     = time;
    table.side     = 3;
    table.spacing  = 4e-3;
    for (std::size_t n = 0; n < 9; ++n) {
        table.compliance[n]       = {value + slope * 4e-3 * (double(n / 3) - 1), slope, 0};
        table.contactStiffness[n] = {std::log(1000.0), 0, 0};
    }
    return table;
}

/// Ticks with a contact that rests; ln c of each.
struct Servo {
    ComplianceTracker handOver;
    PublishedTables   published;
    double            time = 0;
    glm::dvec3        contact{};
    bool              touching = true;

    explicit Servo(ComplianceLaw law = ComplianceLaw::table) : handOver(law) {}

    double tick(const ComplianceTable& table, double dt = kTick)
    {
        time += dt;
        const auto handed = handOver.tick({contact, time, dt, published.place(table, handOver), touching});
        return handed ? std::log(handed->compliance) : std::numeric_limits<double>::quiet_NaN();
    }
};

TEST(ComplianceTracker, GivesNothingBeforeTheFirstTable)
{
    ComplianceTracker handOver;
    EXPECT_FALSE(handOver.tick({{}, 0, kTick, nullptr}).has_value());
    const ComplianceTable none;
    EXPECT_FALSE(handOver.tick({{}, 0, kTick, &none}).has_value()) << "sequence 0 is no table";
    const auto first  = tableOf(1, -6, 0, 0.010);
    const auto handed = handOver.tick({{}, 0.030, kTick, &first});
    ASSERT_TRUE(handed.has_value());
    EXPECT_NEAR(std::log(handed->compliance), -6, 1e-12) << "at once, without an offset";
    EXPECT_NEAR(handed->contactStiffness, 1000, 1e-9);
    EXPECT_NEAR(handed->age, 0.020, 1e-12);
}

TEST(ComplianceTracker, LooksUpThePlaceOfTheContactInTheTablesOwnAxes)
{
    ComplianceTracker handOver;
    auto              table = tableOf(1, -6, 50);
    table.chart.origin      = {0.1, 0.2, 0.3};
    table.chart.frame       = Frame{}.turned(std::acos(0.0)); // east is the world's y
    const auto handed       = handOver.tick({{0.1, 0.203, 0.3}, 0, kTick, &table});
    EXPECT_NEAR(std::log(handed->compliance), -6 + 50 * 3e-3, 1e-12);
    EXPECT_FALSE(handed->clamped);
    EXPECT_TRUE(handOver.tick({{0.1, 0.205, 0.3}, 0, kTick, &table})->clamped);
}

/// Along a great circle the azimuthal map's radius is the chord: 2 r sin(angle/2).
TEST(ComplianceTracker, FindsPlacesOnACurvedSurfaceAndOffItAlike)
{
    ComplianceTracker handOver;
    auto              table  = tableOf(1, -6, 50);
    const double      radius = 20e-3, angle = 0.15;
    table.chart.curvature = 1 / radius;
    const glm::dvec3 centre{0, 0, -radius}, direction{std::sin(angle), 0, std::cos(angle)};
    for (double lift : {0.0, 1e-3, -1e-3}) {
        const auto handed = handOver.tick({centre + (radius + lift) * direction, 0, kTick, &table});
        EXPECT_NEAR(std::log(handed->compliance), -6 + 50 * 2 * radius * std::sin(angle / 2), 1e-12) << lift;
    }
}

TEST(ComplianceTracker, AJumpBetweenTablesDiesAtOnePerCentPerMillisecond)
{
    Servo servo;
    (void)servo.tick(tableOf(1, -6));
    const auto second = tableOf(2, -6.1); // a tenth: three periods' worth at 1 % per ms
    EXPECT_NEAR(servo.tick(second), -6, 1e-12) << "continuous where the table changes";
    for (int n = 1; n <= 10; ++n) EXPECT_NEAR(servo.tick(second), -6 - 0.01 * n, 1e-9) << n;
    EXPECT_NEAR(servo.tick(second), -6.1, 1e-12) << "and then none is left";
}

TEST(ComplianceTracker, TheOffsetDiesInTimeAndNotInTicks)
{
    Servo fine, coarse;
    (void)fine.tick(tableOf(1, -6));
    (void)coarse.tick(tableOf(1, -6));
    const auto second = tableOf(2, -5.9);
    (void)fine.tick(second);
    (void)coarse.tick(second);
    for (int n = 0; n < 12; ++n) (void)fine.tick(second, kTick / 4);
    EXPECT_NEAR(fine.tick(second, 0), -5.97, 1e-12) << "0.03 of 0.1 in 3 ms";
    EXPECT_NEAR(coarse.tick(second, 3 * kTick), -5.97, 1e-12);
}

TEST(ComplianceTracker, ALargeJumpIsGoneWithinOnePeriodOfTheTables)
{
    constexpr int kPeriod = 20; // ticks
    Servo         servo;
    for (std::uint64_t n = 1; n <= 40; ++n) {
        const auto table = tableOf(n, -6);
        for (int tick = 0; tick < kPeriod; ++tick) (void)servo.tick(table);
    }
    EXPECT_NEAR(servo.handOver.period(), kPeriod * kTick, 1e-5) << "smoothed over some tables";
    const auto far  = tableOf(41, -8);
    double     last = servo.tick(far);
    for (int tick = 0; tick < kPeriod; ++tick) {
        const double now = servo.tick(far);
        EXPECT_NEAR(last - now, 2.0 / kPeriod, 1e-4) << "evenly";
        last = now;
    }
    EXPECT_NEAR(last, -8, 1e-3);
}

TEST(ComplianceTracker, OffsetsAddUpWhenTablesDisagreeInARow)
{
    Servo servo;
    (void)servo.tick(tableOf(1, -6));
    (void)servo.tick(tableOf(2, -5.95));
    EXPECT_NEAR(servo.tick(tableOf(3, -5.9)), -5.99, 1e-9) << "0.01 died, the rest is carried on";
}

TEST(ComplianceTracker, HoldStepsAndBlendTakesAPeriod)
{
    Servo hold(ComplianceLaw::hold), blend(ComplianceLaw::blend);
    for (Servo* servo : {&hold, &blend}) {
        servo->contact = {3e-3, 0, 0}; // neither law looks where the contact is
        EXPECT_NEAR(servo->tick(tableOf(1, -6, 50)), -6, 1e-12);
    }
    const auto second = tableOf(2, -7, 50);
    EXPECT_NEAR(hold.tick(second), -7, 1e-12);
    EXPECT_NEAR(blend.tick(second), -6, 1e-12);
    const double period = blend.handOver.period();
    EXPECT_NEAR(blend.tick(second, period / 4), -6.25, 1e-12);
    EXPECT_NEAR(blend.tick(second, period), -7, 1e-12);
}

/// Until the first table of a contact comes, a table that was made for it goes over smoothly and another one at once.
TEST(ComplianceTracker, ANewContactCarriesAnOffsetOnlyFromATableThatWasMadeForIt)
{
    enum class Before { fits, beyondReach, old };
    for (ComplianceLaw law : {ComplianceLaw::table, ComplianceLaw::blend})
        for (Before before : {Before::fits, Before::beyondReach, Before::old}) {
            if (law == ComplianceLaw::blend && before == Before::beyondReach) continue; // it does not look
            Servo servo(law);
            servo.touching = false;
            (void)servo.tick(tableOf(1, -6));
            if (before == Before::beyondReach) servo.contact = {4.1e-3, 0, 0};
            if (before == Before::old) servo.time += 2 * servo.handOver.period();
            servo.touching = true;
            (void)servo.tick(tableOf(1, -6));
            const double next = servo.tick(tableOf(2, -5));
            EXPECT_NEAR(next, before == Before::fits ? -6 : -5, 1e-12) << name(law) << int(before);
        }
}

TEST(ComplianceTracker, TablesChangeInFreeSpaceWithoutAnOffset)
{
    Servo servo;
    (void)servo.tick(tableOf(1, -6));
    servo.touching = false;
    EXPECT_NEAR(servo.tick(tableOf(2, -5)), -5, 1e-12);
    servo.touching = true;
    EXPECT_NEAR(servo.tick(tableOf(2, -5)), -5, 1e-12) << "nor does the next contact find one";
}

TEST(ComplianceTracker, TimeInTheAirIsNoPeriod)
{
    constexpr int kPeriod = 17; // ticks
    Servo         servo;
    std::uint64_t sequence = 0;
    const auto    touchFor = [&](int ticks) {
        for (int tick = 0; tick < ticks; ++tick) (void)servo.tick(tableOf(1 + sequence++ / kPeriod, -6));
    };
    touchFor(40 * kPeriod);
    const double before = servo.handOver.period();
    EXPECT_NEAR(before, kPeriod * kTick, 1e-5);
    for (int lift = 0; lift < 5; ++lift) { // 60 ms without a new table, then half of a period until one comes
        servo.touching = false;
        for (int tick = 0; tick < 60; ++tick) (void)servo.tick(tableOf(sequence / kPeriod, -6));
        servo.touching = true;
        touchFor(2 * kPeriod);
    }
    EXPECT_NEAR(servo.handOver.period(), before, 1e-5);
}

/// ln c = -5 and k_c = 500 N/m about the origin.
HomogeneousLaw lawAtTheOrigin()
{
    return {{{{0, 0, 0}, -5, std::log(500.0)}}, 2e-3};
}

TEST(ComplianceTracker, TheHomogeneousLawAnswersUntilTheFirstTableAndGoesOverSmoothly)
{
    const HomogeneousLaw law = lawAtTheOrigin();
    Servo                servo;
    servo.handOver = ComplianceTracker(ComplianceLaw::table, &law);
    const ComplianceTable none;
    EXPECT_NEAR(servo.tick(none), -5, 1e-12);
    EXPECT_TRUE(servo.handOver.tick({{}, servo.time, 0, &none})->clamped) << "it is no table's";
    EXPECT_NEAR(servo.tick(tableOf(1, -5.5)), -5, 1e-12);
    double last = -5;
    for (int n = 0; n < 40; ++n) last = servo.tick(tableOf(1, -5.5));
    EXPECT_NEAR(last, -5.5, 1e-12) << "within a period of 33 ms";
}

TEST(ComplianceTracker, TheHomogeneousLawAnswersBeyondTheReachOfAnOldTableOnly)
{
    const HomogeneousLaw law = lawAtTheOrigin();
    for (const double away : {0.0, 20e-3}) {
        Servo servo;
        servo.handOver     = ComplianceTracker(ComplianceLaw::table, &law);
        auto table         = tableOf(1, -6);
        table.chart.origin = {away, 0, 0};
        servo.touching     = false;
        (void)servo.tick(table);
        servo.touching = true;
        EXPECT_NEAR(servo.tick(table), away > 0 ? -5 : -6, 1e-12) << away;
    }
}

TEST(ComplianceTracker, WhereTheHomogeneousLawHasNoSiteTheLastFeltValueStays)
{
    const HomogeneousLaw law = lawAtTheOrigin();
    Servo                servo;
    servo.handOver = ComplianceTracker(ComplianceLaw::table, &law);
    const ComplianceTable none;
    ASSERT_NEAR(servo.tick(none), -5, 1e-12);
    servo.contact    = {5e-3, 0, 0};
    const auto there = servo.handOver.tick({servo.contact, servo.time, 0, &none});
    ASSERT_TRUE(there);
    EXPECT_NEAR(std::log(there->compliance), -5, 1e-12);
    EXPECT_NEAR(there->contactStiffness, 500, 1e-9);
    EXPECT_TRUE(there->clamped);
}

TEST(ComplianceTracker, NoTableForAQuarterOfASecondIsNoAnswer)
{
    const HomogeneousLaw  law = lawAtTheOrigin();
    ComplianceTracker     tracker(ComplianceLaw::table, &law);
    const ComplianceTable none;
    for (int n = 0; n <= 600; ++n) {
        const bool touching = n != 300; // a new contact has its own quarter of a second
        const auto here     = tracker.tick({{}, n * kTick, kTick, &none, touching});
        if (n % 301 != 250 && touching) {
            EXPECT_EQ(here.has_value(), n % 301 < 250) << n;
        }
        if (here && touching) {
            EXPECT_NEAR(here->age, (n < 300 ? n : n - 301) * kTick, 1e-9) << n;
        }
    }
    EXPECT_FALSE(tracker.tick({{5e-3, 0, 0}, 1, kTick, &none}).has_value()) << "no site is near";
}

/// What was touched before has a table, and what is touched now has none: the one that ended is of another place.
TEST(ComplianceTracker, ATableThatEndedIsNotFeltWhereTheHomogeneousLawAnswers)
{
    const HomogeneousLaw law = lawAtTheOrigin();
    for (const bool began : {true, false}) { // beyond the reach of that table, or on it
        Servo servo;
        servo.handOver     = ComplianceTracker(ComplianceLaw::table, &law);
        auto table         = tableOf(1, -6);
        table.chart.origin = {began ? 20e-3 : 0, 0, 0};
        servo.touching     = false;
        (void)servo.tick(table);
        servo.touching = true;
        (void)servo.tick(table);
        table.sequence = 2;
        table.ended    = true;
        for (int n = 0; n < 100; ++n) EXPECT_NEAR(servo.tick(table), began ? -5 : -6, 1e-12) << n;
        auto   own  = tableOf(3, -5.5);
        double last = 0;
        for (int n = 0; n < 100; ++n) last = servo.tick(own);
        EXPECT_NEAR(last, -5.5, 1e-12) << "one of its own is";
    }
}

TEST(ComplianceTracker, TheHomogeneousLawAnswersAsLongAsASlowThreadMayTake)
{
    const HomogeneousLaw  law = lawAtTheOrigin();
    ComplianceTracker     tracker(ComplianceLaw::table, &law, 1.5);
    const ComplianceTable none;
    for (int n = 0; n < 1500; ++n) EXPECT_TRUE(tracker.tick({{}, n * kTick, kTick, &none})) << n;
    EXPECT_FALSE(tracker.tick({{}, 1.51, 10 * kTick, &none}));
}

TEST(ComplianceTracker, WhatIsNotUsableIsNotTaken)
{
    Servo servo;
    (void)servo.tick(tableOf(1, -6));
    auto bad                = tableOf(2, -7);
    bad.compliance[4].value = std::numeric_limits<double>::quiet_NaN();
    for (int n = 0; n < 5; ++n) EXPECT_NEAR(servo.tick(bad), -6, 1e-12);
    EXPECT_NEAR(servo.tick(tableOf(3, -6)), -6, 1e-12);
}

TEST(ComplianceTracker, AContactThatIsNotANumberOrRoundTheBackKeepsWhatWasFelt)
{
    Servo servo;
    auto  table           = tableOf(1, -6, 50);
    table.chart.curvature = 50;
    servo.contact         = {2e-3, 0, 0};
    const double felt     = servo.tick(table);
    servo.contact.x       = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(servo.tick(table), felt);
    servo.contact = {0, 0, -39e-3}; // beyond the centre, 20 mm below
    EXPECT_EQ(servo.tick(table), felt);
    EXPECT_TRUE(servo.handOver.tick({servo.contact, servo.time, 0, &table})->clamped);
}

TEST(ComplianceTracker, AStalledDeformationThreadLeavesAFiniteForceAndAnAge)
{
    Servo      servo;
    const auto table = tableOf(1, -6, 50);
    double     last  = servo.tick(table);
    for (int n = 0; n < 5000; ++n) { // 5 s, half a metre
        servo.contact.x += 1e-4;
        const double now = servo.tick(table);
        EXPECT_LT(std::abs(now - last), 50 * 1.1e-4);
        last = now;
    }
    EXPECT_NEAR(last, -6 + 50 * 4e-3, 1e-12) << "at the reach";
    EXPECT_NEAR(servo.handOver.tick({servo.contact, servo.time, 0, &table})->age, 5.001, 1e-9);
    const auto next = tableOf(2, -6);
    EXPECT_NEAR(servo.tick(next), last, 1e-9);
    EXPECT_LT(servo.handOver.period(), 0.06) << "a stall is no period";
}

TEST(ComplianceTracker, AllocatesNothing)
{
    const HomogeneousLaw first = lawAtTheOrigin();
    for (ComplianceLaw law : {ComplianceLaw::table, ComplianceLaw::hold, ComplianceLaw::blend}) {
        Servo servo(law);
        servo.handOver = ComplianceTracker(law, &first);
        const ComplianceTable none;
        const auto            one = tableOf(1, -6, 50), two = tableOf(2, -7, 50);
        const auto            before = allocationsOfThisThread();
        for (int n = 0; n < 10; ++n) (void)servo.tick(none);
        for (int n = 0; n < 10; ++n) (void)servo.tick(one);
        for (int n = 0; n < 10; ++n) (void)servo.tick(two);
        EXPECT_EQ(allocationsOfThisThread(), before) << name(law);
    }
    static_assert(noexcept(std::declval<ComplianceTracker>().tick({})));
}

TEST(ComplianceTracker, NamesFindTheirLaw)
{
    for (ComplianceLaw law : {ComplianceLaw::table, ComplianceLaw::hold, ComplianceLaw::blend})
        EXPECT_EQ(valueNamed<ComplianceLaw>(name(law)), law);
    EXPECT_FALSE(valueNamed<ComplianceLaw>("extrapolate").has_value());
}

} // namespace
} // namespace palp
