#include "engine/plate/multigrid/detail/chebyshev.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/contract.h"

namespace palp {
namespace {

/// What is left of an error of 1 along an eigenvector of this value.
double leftOf(const std::vector<ChebyshevStep>& steps, double eigenvalue)
{
    double error = 1, before = 1;
    for (const ChebyshevStep& step : steps) {
        const double next = error + double(step.ahead) * (error - before) - double(step.step) * eigenvalue * error;
        before            = error;
        error             = next;
    }
    return error;
}

/// T_n(x), from its recurrence.
double chebyshev(int n, double x)
{
    double before = 1, now = x;
    for (int m = 1; m < n; ++m) {
        const double next = 2 * x * now - before;
        before            = now;
        now               = next;
    }
    return n == 0 ? 1 : now;
}

TEST(Chebyshev, WhatIsLeftIsTheScaledPolynomial)
{
    constexpr double kSmallest = 0.25, kLargest = 4;
    for (int count = 1; count <= 6; ++count) {
        const auto steps = chebyshevSteps(count, kSmallest, kLargest);
        ASSERT_EQ(int(steps.size()), count);
        EXPECT_EQ(steps.front().ahead, 0.0F);
        for (double eigenvalue = 0; eigenvalue <= 1.2 * kLargest; eigenvalue += 0.01) {
            const auto   place    = [&](double x) { return (kLargest + kSmallest - 2 * x) / (kLargest - kSmallest); };
            const double expected = chebyshev(count, place(eigenvalue)) / chebyshev(count, place(0));
            EXPECT_NEAR(leftOf(steps, eigenvalue), expected, 1e-6 * std::max(1.0, std::abs(expected)))
                << "coefficients are floats; " << count << " steps, eigenvalue " << eigenvalue;
        }
    }
}

TEST(Chebyshev, OneStepIsJacobisWithTheBestDamping)
{
    const auto steps = chebyshevSteps(1, 1, 3);
    EXPECT_EQ(steps.front().step, 0.5F); // 2 / (1 + 3)
}

TEST(Chebyshev, NoStepsAndEmptyIntervalsAreRefused)
{
    EXPECT_THROW(static_cast<void>(chebyshevSteps(0, 1, 2)), ContractViolation);
    EXPECT_THROW(static_cast<void>(chebyshevSteps(2, 0, 2)), ContractViolation);
    EXPECT_THROW(static_cast<void>(chebyshevSteps(2, 2, 2)), ContractViolation);
}

} // namespace
} // namespace palp
