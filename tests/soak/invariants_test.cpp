#include "tests/soak/invariants.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace palp::soak {
namespace {

constexpr double kTick = 1e-3, kMost = 6; // [s], [N]

/// A hand that holds 1 N at a contact.
TickRecord pressing()
{
    TickRecord record;
    record.normal = {0, 0, 1};
    record.force = record.wanted = {0, 0, 1};
    record.answers               = 1;
    return record;
}

/// Returns what is said of a tick after ten that are fine.
std::string wrongAfter(const TickRecord& record, double dt = kTick)
{
    const GovernorSettings limits;
    Invariants             invariants(kMost, 0);
    TickRecord             fine = pressing();
    for (int n = 1; n <= 10; ++n) {
        fine.force.z = 0.1 * n;
        EXPECT_EQ(invariants.check(fine, {}, kTick, limits), std::nullopt);
    }
    return invariants.check(record, {}, dt, limits).value_or("");
}

/// Returns what is said of the first of a row of ticks of which something is said, and which it was.
std::pair<std::string, int> firstWrong(const TickRecord& record, int ticks)
{
    const GovernorSettings limits;
    Invariants             invariants(kMost, 0);
    for (int n = 0; n < ticks; ++n)
        if (const auto wrong = invariants.check(record, {}, kTick, limits)) return {*wrong, n};
    return {"", ticks};
}

TEST(SoakInvariants, EachWrongTickIsSeen)
{
    EXPECT_EQ(wrongAfter(pressing()), "");
    struct Case {
        const char*                      words;
        std::function<void(TickRecord&)> spoil;
        double                           dt = kTick;
    };
    const double nan = std::nan("");
    for (const auto& [words, spoil, dt] :
         {Case{"not finite", [&](TickRecord& r) { r.force.x = nan; }},
          Case{"above its limit", [](TickRecord& r) { r.force.z = kMost + 1e-6; }},
          Case{"grew by", [](TickRecord& r) { r.force.z = 2.1; }}, // the slew is 1 N in a tick
          Case{"grew by", [](TickRecord& r) { r.force.z = 1.1; }, 0},
          Case{"changed by",
               [](TickRecord& r) {
                   r.force = {1.5, 0, -0.5};
               }},
          Case{"tank holds", [](TickRecord& r) { r.tankEnergy = -1e-6; }},
          Case{"tank holds", [](TickRecord& r) { r.tankEnergy = 1e3; }},
          Case{"tank holds", [&](TickRecord& r) { r.tankEnergy = nan; }},
          Case{"observer counts", [](TickRecord& r) { r.observerEnergy = -0.21; }},
          Case{"observer counts", [&](TickRecord& r) { r.observerEnergy = nan; }},
          Case{"stiffness is", [](TickRecord& r) { r.stiffness = -1; }},
          Case{"no fault", [&](TickRecord& r) { r.hip.y = nan; }},
          Case{"no fault", [&](TickRecord& r) { r.hipVelocity.y = nan; }},
          Case{"no fault", [](TickRecord& r) { r.missed = 21; }}, Case{"no fault", [](TickRecord&) {}, 0.2},
          Case{"no fault", [](TickRecord&) {}, std::numeric_limits<double>::infinity()},
          Case{"no reason is recorded", [](TickRecord& r) { r.force = {}; }}}) {
        TickRecord record = pressing();
        spoil(record);
        EXPECT_NE(wrongAfter(record, dt).find(words), std::string::npos) << words << ": " << wrongAfter(record, dt);
    }
}

TEST(SoakInvariants, AForceThatGoesOnIsSeen)
{
    TickRecord faulty  = pressing();
    faulty.force.z     = 1e-3;
    faulty.faults      = 1;
    const auto latched = firstWrong(faulty, 100);
    EXPECT_NE(latched.first.find("latched a fault"), std::string::npos) << latched.first;
    EXPECT_EQ(latched.second, 21); // 20 ms of ramp, and a tick

    TickRecord away = pressing();
    away.force.z    = 1e-3;
    away.normal     = {};
    const auto left = firstWrong(away, 1000);
    EXPECT_NE(left.first.find("after the last contact"), std::string::npos) << left.first;
    EXPECT_EQ(left.second, 150);
}

TEST(SoakInvariants, AWrongTableIsSeen)
{
    ComplianceTable table;
    table.side                = 1;
    table.sequence            = 7;
    table.compliance[0].value = 1e-3;
    Invariants invariants(kMost, 0);
    invariants.handsOver(table);
    EXPECT_EQ(invariants.checkTable(&table, true), std::nullopt);

    ComplianceTable changed     = table;
    changed.compliance[0].value = std::nextafter(1e-3, 1);
    EXPECT_EQ(invariants.checkTable(&changed, false), std::nullopt);
    EXPECT_NE(invariants.checkTable(&changed, true).value_or("").find("was changed"), std::string::npos);

    changed.compliance[0].value = std::nan("");
    EXPECT_NE(invariants.checkTable(&changed, false).value_or("").find("not usable"), std::string::npos);

    ComplianceTable older = table;
    older.sequence        = 6;
    EXPECT_NE(invariants.checkTable(&older, false).value_or("").find("after table 7"), std::string::npos);
}

} // namespace
} // namespace palp::soak
