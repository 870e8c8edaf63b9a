#include "engine/force/compliance_table.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kSpacing = 4e-3; // [m]

/// A table of the functions c(x, z) and their slopes, in units of the spacing.
template <class Value, class SlopeX, class SlopeZ>
ComplianceTable tableOf(int side, Value value, SlopeX slopeX, SlopeZ slopeZ)
{
    ComplianceTable table;
    table.sequence = 1;
    table.side     = side;
    table.spacing  = kSpacing;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const double x = i - side / 2, z = j - side / 2;
            const auto   n            = std::size_t(i * side + j);
            table.compliance[n]       = {value(x, z), slopeX(x, z) / kSpacing, slopeZ(x, z) / kSpacing};
            table.contactStiffness[n] = {-value(x, z), -slopeX(x, z) / kSpacing, -slopeZ(x, z) / kSpacing};
        }
    return table;
}

TEST(ComplianceTable, ReproducesCubicsAlongBothAxesAndTheirTwist)
{
    const auto value  = [](double x, double z) { return x * x * x - 2 * x * x + 3 * x * z + z * z * z - 1; };
    const auto slopeX = [](double x, double z) { return 3 * x * x - 4 * x + 3 * z; };
    const auto slopeZ = [](double x, double z) { return 3 * x + 3 * z * z; };
    for (int side : {3, 5, 7}) {
        const ComplianceTable                  table = tableOf(side, value, slopeX, slopeZ);
        std::mt19937_64                        bits{std::uint64_t(side)};
        std::uniform_real_distribution<double> inside(-side / 2, side / 2);
        for (int n = 0; n < 100; ++n) {
            const double x = inside(bits), z = inside(bits);
            const auto   look = table.at({x * kSpacing, z * kSpacing});
            EXPECT_NEAR(look.lnCompliance, value(x, z), 1e-12) << "rounding of cubes of 3";
            EXPECT_NEAR(look.lnContactStiffness, -value(x, z), 1e-12) << "the other function, likewise";
            EXPECT_FALSE(look.clamped);
        }
    }
}

/// Its mixed derivative changes from entry to entry, and differences of both sides find it where both sides are there.
TEST(ComplianceTable, ReproducesAProductOfSquaresWithinItsOutermostCells)
{
    const auto            value  = [](double x, double z) { return x * x * z * z; };
    const auto            slopeX = [](double x, double z) { return 2 * x * z * z; };
    const auto            slopeZ = [](double x, double z) { return 2 * x * x * z; };
    const ComplianceTable table  = tableOf(7, value, slopeX, slopeZ);
    for (double x = -2; x <= 2; x += 0.25)
        for (double z = -2; z <= 2; z += 0.25)
            EXPECT_NEAR(table.at({x * kSpacing, z * kSpacing}).lnCompliance, value(x, z), 1e-12) << x << ", " << z;
}

TEST(ComplianceTable, AStiffeningIsReadWhereThereIsOneAndNeverNegative)
{
    const auto one   = [](double, double) { return 1.0; };
    auto       table = tableOf(3, one, one, one);
    for (std::size_t n = 0; n < 9; ++n) table.stiffening[n] = {double(n), 3 / kSpacing, 1 / kSpacing};
    EXPECT_FALSE(table.at({}).stiffening.has_value());
    EXPECT_FALSE(table.middle().stiffening.has_value());

    table.stiffens = true;
    EXPECT_EQ(table.middle().stiffening, 4.0);
    EXPECT_NEAR(table.at({0.5 * kSpacing, -0.5 * kSpacing}).stiffening.value(), 4 + 1.5 - 0.5, 1e-14) << "3 x + z";

    table.stiffening[4] = {0.1, 9 / kSpacing, 0};
    EXPECT_EQ(table.at({-0.3 * kSpacing, 0}).stiffening, 0.0) << "the cubic has its least below 0";

    EXPECT_TRUE(table.usable());
    table.stiffening[8].slopeX = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(table.usable());
    table.stiffens = false;
    EXPECT_TRUE(table.usable()) << "nobody looks at it";
}

TEST(ComplianceTable, IsContinuousWithItsSlopesAcrossTheCells)
{
    std::mt19937_64                  bits(1);
    std::normal_distribution<double> random;
    const auto                       any   = [&](double, double) { return random(bits); };
    const ComplianceTable            table = tableOf(5, any, any, any);
    constexpr double                 kStep = 1e-6; // of the spacing [1]
    for (double z : {-1.7, -0.3, 0.9})
        for (double x : {-1.0, 0.0, 1.0}) {
            const auto at = [&](double dx) { return table.at({(x + dx) * kSpacing, z * kSpacing}).lnCompliance; };
            EXPECT_NEAR(at(-kStep), at(kStep), 1e-5) << "values";
            EXPECT_NEAR((at(0) - at(-kStep)) / kStep, (at(kStep) - at(0)) / kStep, 1e-3) << "slopes";
        }
}

TEST(ComplianceTable, BeyondItsReachTheNearestPlaceAnswersAndItSaysSo)
{
    const auto value = [](double x, double z) { return x + 2 * z; };
    const auto table = tableOf(
        3, value, [](double, double) { return 1.0; }, [](double, double) { return 2.0; });
    const auto beyond = table.at({1.5 * kSpacing, 0.5 * kSpacing});
    EXPECT_TRUE(beyond.clamped);
    EXPECT_NEAR(beyond.lnCompliance, 1 + 2 * 0.5, 1e-14);
    EXPECT_FALSE(table.at({kSpacing, -kSpacing}).clamped) << "the rim belongs to it";
    EXPECT_DOUBLE_EQ(table.reach(), kSpacing);
    EXPECT_TRUE(std::isnan(table.at({std::numeric_limits<double>::quiet_NaN(), 0}).lnCompliance));
    EXPECT_FALSE(std::isnan(table.at({std::numeric_limits<double>::infinity(), 0}).lnCompliance));
}

TEST(ComplianceTable, OneEntryIsOneNumberEverywhere)
{
    const auto three = [](double, double) { return 3.0; };
    const auto table = tableOf(1, three, three, three);
    EXPECT_EQ(table.at({}).lnCompliance, 3);
    EXPECT_FALSE(table.at({}).clamped);
    EXPECT_EQ(table.at({1e-6, 0}).lnCompliance, 3);
    EXPECT_TRUE(table.at({1e-6, 0}).clamped) << "no reach at all";
}

TEST(ComplianceTable, IsUsableOnlyWithAShapeAndFiniteEntries)
{
    const auto            one  = [](double, double) { return 1.0; };
    const ComplianceTable good = tableOf(3, one, one, one);
    EXPECT_TRUE(good.usable());
    for (int side : {0, 2, 9, -1}) {
        ComplianceTable bad = good;
        bad.side            = side;
        EXPECT_FALSE(bad.usable()) << side;
    }
    for (double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        ComplianceTable bad      = good;
        bad.compliance[8].slopeZ = value;
        EXPECT_FALSE(bad.usable());
        bad                           = good;
        bad.contactStiffness[0].value = value;
        EXPECT_FALSE(bad.usable());
        bad                     = good;
        bad.compliance[9].value = value;
        EXPECT_TRUE(bad.usable()) << "beyond side * side nothing is looked at";
    }
    ComplianceTable flat = good;
    flat.spacing         = 0;
    EXPECT_FALSE(flat.usable());
}

} // namespace
} // namespace palp
