#include "engine/tools/fit/depth_fit.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "engine/cloud/material.h"
#include "engine/force/relaxing_contact.h"

namespace palp::fit {
namespace {

constexpr double kK = 250, kB = 810; ///< [N/m], [1/m] liver

/// Returns a press to 2.5 mm with noise.
Probe pressed(std::size_t rows, double noise, std::mt19937_64& random)
{
    const DepthLaw                   law{kK, kB};
    std::normal_distribution<double> normal(0, noise);
    Probe                            probe;
    probe.name = "1";
    for (std::size_t n = 0; n < rows; ++n) {
        probe.depth.push_back(2.5e-3 * double(n) / double(rows - 1));
        probe.force.push_back(law.force(probe.depth.back()) + normal(random));
    }
    return probe;
}

/// Returns a press within 0.5 s to 2 mm that is held for 10 s.
Probe held(const Relaxation& relaxation, double noise, std::mt19937_64& random)
{
    RelaxingContact                  contact(relaxation, 4e-3);
    std::normal_distribution<double> normal(0, noise);
    Probe                            probe;
    probe.name = "held";
    for (int n = 0; n <= 525; ++n) {
        const double time = 0.02 * n;
        probe.time.push_back(time);
        probe.depth.push_back(2e-3 * std::min(1.0, time / 0.5));
        probe.force.push_back(contact.step({{kK, kB}, probe.depth.back(), {}, n == 0 ? 0 : 0.02}).force +
                              normal(random));
    }
    return probe;
}

TEST(DepthFit, AnExactPressGivesItsNumbersBack)
{
    std::mt19937_64 random(1);
    const ProbeFit  fit = fitProbe(pressed(10, 0, random));

    EXPECT_NEAR(fit.stiffness.value / kK, 1, 1e-5);
    EXPECT_NEAR(fit.stiffening.value / kB, 1, 1e-5);
    EXPECT_LT(fit.residual, 1e-6);
    EXPECT_EQ(fit.relaxation.count, 0u) << "no times were measured";
}

/// A press of a tenth of a millimetre whose force comes all at once: b is one that a scene takes.
TEST(DepthFit, AShallowPressStiffensNoMoreThanAScenes)
{
    Probe probe;
    for (int n = 0; n <= 10; ++n) {
        probe.depth.push_back(1e-5 * n);
        probe.force.push_back(n == 10 ? 1 : 0);
    }
    EXPECT_LE(fitProbe(probe).stiffening.value, kMostStiffening);
    EXPECT_GT(fitProbe(probe).stiffening.value, 0.5 * kMostStiffening) << "or it shows nothing";
}

TEST(DepthFit, ALinearPressHasNoStiffeningAndTheLawsAreTold)
{
    Probe probe;
    for (int n = 0; n < 8; ++n) probe.depth.push_back(5e-4 * n), probe.force.push_back(0.2 * n);
    const ProbeFit fit = fitProbe(probe);

    EXPECT_NEAR(fit.stiffness.value, 400, 0.1);
    EXPECT_LT(fit.stiffening.value, 0.5);
    EXPECT_LT(fit.others[0].residual, 1e-12) << "linear";
    EXPECT_GT(fit.others[1].residual, 0.02) << "Hertz";

    for (std::size_t n = 0; n < 8; ++n) probe.force[n] = 3e4 * std::pow(probe.depth[n], 1.5);
    EXPECT_LT(fitProbe(probe).others[1].residual, 1e-12);
    for (std::size_t n = 0; n < 8; ++n) probe.force[n] = 300 * probe.depth[n] + 4e7 * std::pow(probe.depth[n], 3);
    EXPECT_LT(fitProbe(probe).others[2].residual, 1e-12);
    EXPECT_GT(fitProbe(probe).others[0].residual, 0.02);
}

TEST(DepthFit, IntervalsHoldTheTruthAsOftenAsTheySay)
{
    std::mt19937_64 random(7);
    constexpr int   kPresses  = 400;
    int             stiffness = 0, stiffening = 0;
    for (int n = 0; n < kPresses; ++n) {
        const ProbeFit fit = fitProbe(pressed(12, 0.02, random));
        stiffness += fit.stiffness.low <= kK && kK <= fit.stiffness.high;
        stiffening += fit.stiffening.low <= kB && kB <= fit.stiffening.high;
    }
    // 95 % of 400 with a deviation of 1.1 %: three deviations to either side.
    EXPECT_NEAR(double(stiffness) / kPresses, 0.95, 0.033);
    EXPECT_NEAR(double(stiffening) / kPresses, 0.95, 0.033);
}

TEST(DepthFit, AHoldGivesItsTermsBack)
{
    std::mt19937_64  random(3);
    const Relaxation meat{{{{0.26, 0.41}, {0.31, 4.3}}}, 2};
    const Probe      probe = held(meat, 2e-3, random);
    const ProbeFit   fit   = fitProbe(probe);

    ASSERT_EQ(fit.relaxation.count, 2u);
    EXPECT_NEAR(fit.stiffness.value / kK, 1, 0.05) << "noise is 0.2 % of the forces, and K is read from the first rows";
    EXPECT_NEAR(fit.relaxation.terms[0].share, 0.26, 0.02);
    EXPECT_NEAR(fit.relaxation.terms[0].time, 0.41, 0.08);
    EXPECT_NEAR(fit.relaxation.terms[1].share, 0.31, 0.02);
    EXPECT_NEAR(fit.relaxation.terms[1].time, 4.3, 0.6);
    EXPECT_LT(fit.times[0].low, 0.41);
    EXPECT_GT(fit.times[0].high, 0.41);
    ASSERT_EQ(fit.others.back().name, "exponential");
    EXPECT_GT(fit.others.back().residual, 10 * fit.residual) << "without relaxation";
}

TEST(DepthFit, WhatDoesNotRelaxGetsNoTerm)
{
    std::mt19937_64 random(4);
    const ProbeFit  fit = fitProbe(held({}, 2e-3, random));

    EXPECT_EQ(fit.relaxation.count, 0u) << relaxationText(fit.relaxation);
}

TEST(DepthFit, AnIntervalIsSaidWhereItIsNarrowerThanTheDigits)
{
    EXPECT_EQ(intervalText({300, 290, 310}, "N/m"), "300 N/m (290 N/m to 310 N/m)");
    EXPECT_EQ(intervalText({300, 299.4, 300}, "N/m"), "300 N/m (299 N/m to 300 N/m)");
    EXPECT_EQ(intervalText({300, 299.94, 300.06}, "N/m"), "300 N/m (+- 0.02 %)");
    EXPECT_EQ(intervalText({0, 0, 0}, "1/m"), "0 1/m (+- 0 %)") << "a stiffening at its bound";
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(intervalText({none, none, none}, "N/m").find('%'), std::string::npos) << "no number is exact";
}

TEST(DepthFit, TogetherIsTheMedian)
{
    std::mt19937_64       random(5);
    std::vector<ProbeFit> fits;
    for (int n = 0; n < 9; ++n) fits.push_back(fitProbe(pressed(12, 0.01, random)));
    const ProbesFit all = together(fits);

    EXPECT_NEAR(all.stiffening / kB, 1, 0.05);
    EXPECT_EQ(all.relaxation.count, 0u);
    EXPECT_LT(all.medianResidual(), 0.01);
    EXPECT_GT(all.medianResidual("linear"), 5 * all.medianResidual());
}

} // namespace
} // namespace palp::fit
