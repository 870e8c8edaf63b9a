#include "engine/tools/fit/least_squares.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace palp::fit {
namespace {

TEST(LeastSquares, FindsTheMinimumOfACurvedValley)
{
    // Rosenbrock's function as two residuals and a third that is always zero.
    const std::array<Parameter, 2> start{{{-1.2, -10, 10}, {1, -10, 10}}};
    const LeastSquares             fit = leastSquares(start, 3, [](std::span<const double> p, std::span<double> r) {
        r[0] = 1 - p[0];
        r[1] = 10 * (p[1] - p[0] * p[0]);
        r[2] = 0;
    });

    EXPECT_TRUE(fit.settled);
    EXPECT_NEAR(fit.parameters[0], 1, 1e-6);
    EXPECT_NEAR(fit.parameters[1], 1, 1e-6);
}

TEST(LeastSquares, StopsAtABoundAndFindsTheRest)
{
    const std::array<Parameter, 2> start{{{1, 0, 2}, {1, 0.5, 2}}};
    const LeastSquares             fit = leastSquares(start, 4, [](std::span<const double> p, std::span<double> r) {
        for (std::size_t n = 0; n < 4; ++n) r[n] = p[0] + p[1] * double(n) - (3 + 0.2 * double(n)); // wants 3 and 0.2
    });

    EXPECT_EQ(fit.parameters[0], 2) << "the highest that is allowed";
    EXPECT_NEAR(fit.parameters[1], 0.2 + 6.0 / 14, 1e-6) << "the best slope through what is left, by hand";
}

TEST(LeastSquares, DeviationsAreThoseOfALine)
{
    // y = 1 + 2 x at 0..3 with residuals 1, -1, -1, 1: s^2 = 4 / 2, of the slope s^2 / 5, of the start s^2 (1/4 +
    // 9/20).
    constexpr std::array           kY{2.0, 2.0, 4.0, 8.0};
    const std::array<Parameter, 2> start{{{0, -10, 10}, {0, -10, 10}}};
    const LeastSquares             fit = leastSquares(start, 4, [&](std::span<const double> p, std::span<double> r) {
        for (std::size_t n = 0; n < 4; ++n) r[n] = p[0] + p[1] * double(n) - kY[n];
    });

    EXPECT_NEAR(fit.parameters[0], 1, 1e-6);
    EXPECT_NEAR(fit.parameters[1], 2, 1e-6);
    EXPECT_NEAR(fit.deviations[1], std::sqrt(2.0 / 5), 1e-6);
    EXPECT_NEAR(fit.deviations[0], std::sqrt(2 * 0.7), 1e-6);
}

TEST(StudentFactor, IsThePublishedTable)
{
    EXPECT_NEAR(studentFactor(3), 3.182, 0.025) << "a series in 1 / freedom";
    EXPECT_NEAR(studentFactor(8), 2.306, 0.001);
    EXPECT_NEAR(studentFactor(1000), 1.962, 0.001);
}

} // namespace
} // namespace palp::fit
