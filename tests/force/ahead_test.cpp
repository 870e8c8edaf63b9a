#include "engine/force/ahead.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace palp {
namespace {

TEST(RecentMotion, IsTheVelocityOverTheLastTenMilliseconds)
{
    RecentMotion motion;
    EXPECT_EQ(glm::length(motion.velocity()), 0);
    motion.add(0, {0, 0, 0});
    EXPECT_EQ(glm::length(motion.velocity()), 0) << "one position is no motion";
    double x = 0;
    for (int n = 1; n <= 100; ++n) motion.add(n * 1e-3, {x += 0.2e-3, 0, 0});
    EXPECT_NEAR(motion.velocity().x, 0.2, 1e-12);
    for (int n = 101; n <= 105; ++n) motion.add(n * 1e-3, {x, 0, 0}); // stops
    EXPECT_NEAR(motion.velocity().x, 0.1, 1e-12) << "half of the last 10 ms";
    for (int n = 106; n <= 110; ++n) motion.add(n * 1e-3, {x, 0, 0});
    EXPECT_NEAR(motion.velocity().x, 0, 1e-12);
}

TEST(RecentMotion, TakesASlowClockAndLeavesOutATimeThatDoesNotAdvance)
{
    RecentMotion motion;
    motion.add(0, {});
    motion.add(0.05, {5e-3, 0, 0});
    EXPECT_NEAR(motion.velocity().x, 0.1, 1e-12) << "the last two, farther apart than 10 ms";
    motion.add(0.05, {9, 9, 9});
    motion.add(0.04, {9, 9, 9});
    EXPECT_NEAR(motion.velocity().x, 0.1, 1e-12);
}

TEST(RecentMotion, TwoPlacesAtOneTimeAreNoVelocity)
{
    RecentMotion motion;
    motion.add(1, {});
    motion.add(1, {5e-3, 0, 0});
    EXPECT_EQ(motion.velocity(), glm::dvec3(0));
}

TEST(Ahead, IsALeadAheadForTheTableAndTheContactForTheOtherLaws)
{
    const glm::dvec3 ahead = aheadOf(ComplianceLaw::table, {1, 2, 3}, {0.2, 0, -0.1}, 0.02);
    EXPECT_NEAR(ahead.x, 1 + 0.02 * 0.2, 1e-15);
    EXPECT_NEAR(ahead.z, 3 - 0.02 * 0.1, 1e-15);
    EXPECT_EQ(aheadOf(ComplianceLaw::hold, {1, 2, 3}, {0.2, 0, 0}, 0.02), glm::dvec3(1, 2, 3));
}

TEST(TableSide, CoversWhatAHandDoesInTwoPeriods)
{
    EXPECT_EQ(tableSide(ComplianceLaw::table, 1.0 / 60, 4e-3), 3) << "3.3 of 4 mm";
    EXPECT_EQ(tableSide(ComplianceLaw::table, 1.0 / 45, 4e-3), 5) << "5.2 of 8 mm";
    EXPECT_EQ(tableSide(ComplianceLaw::table, 1.0 / 30, 4e-3), 7) << "10 of 12 mm";
    EXPECT_EQ(tableSide(ComplianceLaw::table, 1.0 / 55, 4e-3), 3) << "3.8 of 4 mm";
    EXPECT_EQ(tableSide(ComplianceLaw::table, 1.0 / 52, 4e-3), 5) << "4.1 of 8 mm";
    EXPECT_EQ(tableSide(ComplianceLaw::table, 1.0 / 10, 4e-3), 7) << "there is no larger one";
    EXPECT_EQ(tableSide(ComplianceLaw::table, 1.0 / 500, 4e-3), 3);
    EXPECT_EQ(tableSide(ComplianceLaw::blend, 1.0 / 30, 4e-3), 1);
}

} // namespace
} // namespace palp
