#include "engine/session/detail/solve_pace.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kPeriod = 1.0 / 60; // [s]

/// Returns the lead once the pace is known [s].
double leadAfter(double every, double took)
{
    SolvePace pace(kPeriod);
    double    lead = 0;
    for (int n = 0; n < 100; ++n) {
        lead = pace.begins(n * every);
        pace.ended(took);
    }
    return lead;
}

TEST(SolvePace, ATableOfAFastSolverIsUsedFromItsSolveOnAndNotAPeriodLater)
{
    EXPECT_NEAR(leadAfter(kPeriod, 0.3e-3), 0.3e-3 + kPeriod / 2, 1e-9);
    EXPECT_NEAR(leadAfter(kPeriod, kPeriod), 1.5 * kPeriod, 1e-9) << "one that needs all of its time";
    EXPECT_NEAR(leadAfter(3 * kPeriod, 2.4 * kPeriod), 2.4 * kPeriod + 1.5 * kPeriod, 1e-9) << "one that is too slow";
}

TEST(SolvePace, TheFirstSolveIsExpectedToNeedItsPeriodAndTheSecondWhatTheFirstDid)
{
    SolvePace pace(kPeriod);
    EXPECT_NEAR(pace.begins(5), 1.5 * kPeriod, 1e-12);
    pace.ended(2e-3);
    EXPECT_NEAR(pace.begins(5 + kPeriod), 2e-3 + kPeriod / 2, 1e-12);
}

TEST(SolvePace, TimeAwayFromTheSurfaceIsNoPeriod)
{
    SolvePace pace(kPeriod);
    pace.begins(1);
    pace.ended(1e-3);
    EXPECT_NEAR(pace.begins(9), 1e-3 + kPeriod / 2, 1e-12);
}

TEST(SolvePace, AStopOfTheProgramDuringASolveIsNoSolve)
{
    SolvePace pace(kPeriod);
    for (int n = 0; n < 10; ++n) {
        pace.begins(n * kPeriod);
        pace.ended(n == 5 ? 3600 : 2e-3);
    }
    EXPECT_NEAR(pace.begins(10 * kPeriod), 2e-3 + kPeriod / 2, 1e-12);

    SolvePace slow(kPeriod);
    for (int n = 0; n < 10; ++n) {
        slow.begins(n);
        slow.ended(1);
    }
    EXPECT_NEAR(slow.begins(10), 1 + kPeriod / 2, 0.2)
        << "a solver that is always so slow is believed from the second on";
}

} // namespace
} // namespace palp
