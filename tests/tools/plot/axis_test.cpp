#include "engine/tools/plot/axis.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

/// Leading digit of a step, after removing its power of ten.
double leadingDigit(double step)
{
    return std::round(1e6 * step / std::pow(10.0, std::floor(std::log10(step) + 1e-9))) / 1e6;
}

TEST(Axis, LinearStepsAreOneTwoOrFiveAndFit)
{
    std::mt19937                           random(3);
    std::uniform_real_distribution<double> exponent(-9, 9), offset(-5, 5);
    for (int n = 0; n < 300; ++n) {
        const double span = std::pow(10.0, exponent(random)), low = offset(random) * span;

        const Axis axis({low, low + span}, Scale::linear, "m", 7);

        ASSERT_GE(axis.ticks().size(), 2U);
        ASSERT_LE(axis.ticks().size(), 7U);
        const double digit = leadingDigit(axis.ticks()[1].value - axis.ticks()[0].value);
        EXPECT_TRUE(digit == 1 || digit == 2 || digit == 5) << digit;
        EXPECT_GE(axis.position(axis.ticks().front().value), -1e-9) << "a tick on the end may round beyond it";
        EXPECT_LE(axis.position(axis.ticks().back().value), 1 + 1e-9);
        for (std::size_t k = 1; k < axis.ticks().size(); ++k)
            EXPECT_NE(axis.ticks()[k].label, axis.ticks()[k - 1].label);
    }
}

TEST(Axis, LabelsCountInThePrefixedUnit)
{
    const Axis axis({0, 0.00042}, Scale::linear, "m", 6);

    EXPECT_EQ(axis.title("deflection"), "deflection [\u00b5m]");
    EXPECT_EQ(axis.ticks().front().label, "0");
    EXPECT_EQ(axis.ticks().back().label, "400");
    EXPECT_EQ(axis.text(0.00042), "420 \u00b5m");
    EXPECT_EQ(axis.text(-1.5e-6), "\u22121.50 \u00b5m");
    EXPECT_EQ(axis.text(1e-9 * 1e-5), "0 \u00b5m") << "rounding error of the axis";
}

TEST(Axis, UnitsWithoutPrefixGetPowersOfTen)
{
    EXPECT_EQ(Axis({0, 5}, Scale::linear, "1", 5).title("ratio"), "ratio");
    EXPECT_EQ(Axis({0, 5e-7}, Scale::linear, "m^2", 5).title("area"), "area [10\u207b\u2079 m^2]");
    EXPECT_EQ(Axis({0, 3000}, Scale::linear, "", 5).ticks().back().label, "3000");
}

TEST(Axis, LogarithmicTicksAreDecadesWithMinorTicksBetween)
{
    const Axis axis({2e-4, 3e-1}, Scale::logarithmic, "N m", 8);

    ASSERT_EQ(axis.ticks().size(), 3U);
    EXPECT_EQ(axis.ticks()[0].label, "1");
    EXPECT_EQ(axis.ticks()[2].label, "100");
    EXPECT_EQ(axis.title("rigidity"), "rigidity [mN m]");
    EXPECT_EQ(axis.minorTicks().size(), 7U + 8U + 8U + 1U) << "0.3 to 0.9, two full decades, 200";
    EXPECT_NEAR(axis.position(std::sqrt(2e-4 * 3e-1)), 0.5, 1e-12) << "the geometric mean, to rounding";
}

TEST(Axis, ShortLogarithmicRangesHaveOneTwoFive)
{
    const Axis axis({0.9, 60}, Scale::logarithmic, "", 9);

    std::vector<std::string> labels;
    for (const Tick& t : axis.ticks()) labels.push_back(t.label);
    EXPECT_EQ(labels, (std::vector<std::string>{"1", "2", "5", "10", "20", "50"}));
    EXPECT_GE(Axis({3.1, 3.9}, Scale::logarithmic, "", 5).ticks().size(), 2U);
}

TEST(Axis, LongLogarithmicRangesUsePowersOfTen)
{
    const Axis axis({1e-12, 1}, Scale::logarithmic, "", 20);

    EXPECT_EQ(axis.ticks().front().label, "10\u207b\u00b9\u00b2");
    EXPECT_LE(Axis({1e-90, 1e90}, Scale::logarithmic, "Pa", 6).ticks().size(), 6U);
}

TEST(Axis, SingleValuesAreWidened)
{
    for (double value : {0.0, 4.2e-3, -7.0, 1e99, 1e-99}) {
        const ValueRange range = widened({value, value}, Scale::linear);
        EXPECT_LT(range.low, value);
        EXPECT_GT(range.high, value);
        EXPECT_GE(Axis({value, value}, Scale::linear, "m", 5).ticks().size(), 2U) << value;
    }
    EXPECT_NEAR(Axis({3, 3}, Scale::logarithmic, "m", 5).position(3), 0.5, 1e-12) << "geometric middle, to rounding";
}

TEST(Axis, RangeLeavesOutWhatCannotBeDrawn)
{
    const std::vector<double> values = {NAN, -1, 5, INFINITY, 0, 2, 1e200};

    const auto linear = rangeOf(values, Scale::linear), logarithmic = rangeOf(values, Scale::logarithmic);

    EXPECT_EQ(linear->low, -1);
    EXPECT_EQ(linear->high, 5);
    EXPECT_EQ(logarithmic->low, 2);
    EXPECT_FALSE(rangeOf(std::vector<double>{NAN}, Scale::linear));
    EXPECT_THROW(Axis({2, 1}, Scale::linear, "m", 5), ContractViolation);
    EXPECT_THROW(Axis({-1, 1}, Scale::logarithmic, "m", 5), ContractViolation);
}

} // namespace
} // namespace palp
