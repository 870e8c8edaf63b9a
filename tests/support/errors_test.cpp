#include "tests/support/errors.h"

#include <vector>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan      = std::numeric_limits<double>::quiet_NaN();

TEST(Errors, AreRelativeToTheLargestValueOfTheTruth)
{
    const NodeField truth(1, 3, std::vector{1.0, -4.0, 2.0}), found(1, 3, std::vector{1.0, -4.5, 2.25});
    EXPECT_EQ(errorOf(truth, truth), 0);
    EXPECT_EQ(errorOf(found, truth), 0.125);
    EXPECT_EQ(errorOf(found, NodeField(1, 3)), 4.5) << "as it is where the truth is zero";
    EXPECT_EQ(largest(found), 4.5);
    EXPECT_EQ(worse(1, -2), 2);
    EXPECT_EQ(worse(3, -2), 3);
}

/// The first place and the last: std::max forgets NaN that comes second, and what comes before NaN.
TEST(Errors, WhatIsNoNumberIsInfinitelyFarOffWhereverItStands)
{
    const NodeField truth(1, 3, std::vector{1.0, -4.0, 2.0});
    for (const double bad : {kNan, kInfinity, -kInfinity})
        for (const int n : {0, 1, 2}) {
            NodeField broken = truth;
            broken(0, n)     = bad;
            EXPECT_EQ(errorOf(broken, truth), kInfinity) << bad << " at " << n;
            EXPECT_EQ(errorOf(truth, broken), kInfinity) << bad << " at " << n;
            EXPECT_EQ(errorOf(broken, broken), kInfinity) << bad << " at " << n;
            EXPECT_EQ(largest(broken), kInfinity) << bad << " at " << n;
        }
    EXPECT_EQ(worse(worse(0, kNan), 1), kInfinity) << "nor is it forgotten";
}

TEST(Errors, AnAnswerOnAnotherGridIsNoAnswer)
{
    EXPECT_THROW((void)errorOf(NodeField(), NodeField(1, 3)), ContractViolation);
}

} // namespace
} // namespace palp
