#include "engine/force/depth_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kMeat = 810; ///< [1/m] median of probes of liver and meat

TEST(DepthLaw, WithoutStiffeningItIsTheSpringToTheBit)
{
    for (const double depth : {0.0, 1.7e-3, 3.1e-2}) {
        const DepthLaw law = DepthLaw::capped(437.3, 0, 1000);
        EXPECT_EQ(law.force(depth), 437.3 * depth);
        EXPECT_EQ(law.secant(depth), 437.3);
        EXPECT_EQ(law.tangent(depth), 437.3);
        EXPECT_EQ(law.energy(depth), 437.3 * depth * depth / 2);
    }
    EXPECT_EQ(DepthLaw::capped(2000, 0, 1000).stiffness, 1000);
}

TEST(DepthLaw, IsTheExponentialUpToTheCapAndStraightBeyond)
{
    const DepthLaw law  = DepthLaw::capped(200, kMeat, 1000);
    const double   bend = std::log(5) / kMeat; // 2 mm: e^{b d} is 5 there

    EXPECT_NEAR(law.force(1e-3), 200 * (std::exp(0.81) - 1) / kMeat, 1e-12);
    EXPECT_NEAR(law.tangent(1e-3), 200 * std::exp(0.81), 1e-9);
    EXPECT_NEAR(law.force(bend), 800 / kMeat, 1e-12);
    EXPECT_NEAR(law.force(bend + 3e-3), 800 / kMeat + 3, 1e-12) << "1000 N/m over 3 mm";
    EXPECT_EQ(law.tangent(bend + 3e-3), 1000);
    for (const double depth : {1e-3, bend, bend + 3e-3})
        EXPECT_NEAR(law.secant(depth) * depth, law.force(depth), 1e-12) << "what a hand is pulled by, over its depth";
    EXPECT_EQ(law.secant(0), 200);
    EXPECT_TRUE(std::isfinite(law.energy(100))) << "no exponential of what lies beyond the cap";
}

TEST(DepthLaw, ItsEnergyIsTheWorkOfItsForceAndItsTangentTheSlope)
{
    for (const double stiffening : {1e-6, 0.1, 10.0, kMeat, 5e3})
        for (const double cap : {1000.0, std::numeric_limits<double>::infinity()}) {
            const DepthLaw   law    = DepthLaw::capped(200, stiffening, cap);
            constexpr double kEnd   = 4e-3;
            constexpr int    kSteps = 4000;
            double           work   = 0;
            for (int n = 0; n < kSteps; ++n) {
                const double from = kEnd * n / kSteps, to = kEnd * (n + 1) / kSteps, middle = (from + to) / 2;
                work += (law.force(from) + 4 * law.force(middle) + law.force(to)) / 6 * (to - from);
                const double slope = (law.force(to) - law.force(from)) / (to - from);
                EXPECT_NEAR(law.tangent(middle) / slope, 1, 3e-3) << "a step of 1 um may hold the bend";
            }
            EXPECT_NEAR(law.energy(kEnd) / work, 1, 1e-6) << stiffening << " " << cap << ": Simpson's rule at the bend";
        }
}

TEST(DepthLaw, TheEnergyOfALittleStiffeningIsRightToRounding)
{
    for (const double x : {1e-6, 1e-3, 9.9e-3, 0.0101, 0.1}) { // b d, on both sides of where the series ends
        const double   d = 2e-3;
        const DepthLaw law{500, x / d, 1e6};
        long double    sum = 0, term = 0.5L;
        for (int n = 3; n < 30; ++n) {
            sum += term;
            term *= static_cast<long double>(x) / n;
        }
        const double expected = static_cast<double>(500 * static_cast<long double>(d) * d * sum);
        EXPECT_NEAR(law.energy(d), expected, 2e-12 * expected) << x << ": where series and difference meet";
    }
}

TEST(DepthLaw, TheDepthOfAForceIsTheInverse)
{
    for (const double stiffening : {0.0, kMeat})
        for (const double depth : {0.0, 0.5e-3, 1.9e-3, 6e-3}) {
            const DepthLaw law = DepthLaw::capped(200, stiffening, 1000);
            EXPECT_NEAR(law.depthOf(law.force(depth)), depth, 1e-15);
        }
    EXPECT_EQ(DepthLaw{}.depthOf(1), 0) << "nothing holds nothing up";
}

/// A dome's: from 1 down to 0.2 and up again, over 2 mm.
DepthShape dome()
{
    DepthShape shape{.step = 2e-3 / DepthShape::kSteps};
    for (std::size_t n = 0; n < shape.tangents.size(); ++n)
        shape.tangents[n] = 0.2 + 0.8 * std::pow(1 - double(n) / 10, 2);
    return shape;
}

/// A flat sheet's: up to 5 times as stiff.
DepthShape sheet()
{
    DepthShape shape{.step = 2e-3 / DepthShape::kSteps};
    for (std::size_t n = 0; n < shape.tangents.size(); ++n) shape.tangents[n] = 1 + std::pow(double(n) / 8, 2);
    return shape;
}

TEST(DepthLaw, OfAShapeEnergyIsTheWorkOfTheForceAndTheTangentItsSlope)
{
    for (const DepthShape& shape : {dome(), sheet()})
        for (const double stiffening : {0.0, 500.0})
            for (const double cap : {300.0, std::numeric_limits<double>::infinity()}) {
                const DepthLaw   law    = DepthLaw::capped(100, stiffening, cap, shape);
                constexpr double kEnd   = 3e-3; // beyond the last knot
                constexpr int    kSteps = 3000;
                double           work = 0, most = 0;
                EXPECT_EQ(law.force(0), 0);
                EXPECT_EQ(law.energy(0), 0);
                EXPECT_EQ(law.tangent(0), 100);
                EXPECT_EQ(law.secant(0), 100);
                for (int n = 0; n < kSteps; ++n) {
                    const double from = kEnd * n / kSteps, to = kEnd * (n + 1) / kSteps, middle = (from + to) / 2;
                    work += (law.force(from) + 4 * law.force(middle) + law.force(to)) / 6 * (to - from);
                    EXPECT_NEAR((law.force(to) - law.force(from)) / (to - from), law.tangent(middle),
                                1e-6 * law.tangent(middle)); // even between knots; each is a whole number of steps
                    most = std::max(most, law.tangent(middle));
                    EXPECT_GE(law.mostTangent(to) * (1 + 1e-12), most);
                    EXPECT_LE(law.tangent(middle), cap);
                }
                EXPECT_NEAR(law.energy(kEnd) / work, 1, 1e-9) << stiffening << " " << cap; // Simpson's rule, of cubics
                for (const double depth : {0.0, 1e-5, 0.9e-3, 1.25e-3, 2e-3, 2.9e-3})
                    EXPECT_NEAR(law.depthOf(law.force(depth)), depth, 1e-9) << depth; // rounding
            }
}

TEST(DepthLaw, OfAnEvenShapeItIsTheOneWithout)
{
    DepthShape even{.step = 0.1e-3};
    even.tangents.fill(1);
    for (const double depth : {0.3e-3, 1.55e-3}) {
        const DepthLaw spring = DepthLaw::capped(200, 0, 1000, even), tissue = DepthLaw::capped(200, kMeat, 1000, even);
        EXPECT_NEAR(spring.force(depth), 200 * depth, 1e-12);
        // Of an exponential chords are right to (b step)^2 / 12, 0.05 %.
        EXPECT_NEAR(tissue.force(depth) / DepthLaw::capped(200, kMeat, 1000).force(depth), 1, 1e-3);
    }
}

TEST(DepthLaw, OfADomeTheLargestTangentIsTheOneAtTheSurface)
{
    const DepthLaw law = DepthLaw::capped(200, 0, 1000, dome());
    for (const double depth : {0.0, 0.7e-3, 1.3e-3, 2e-3}) EXPECT_EQ(law.mostTangent(depth), 200);
    EXPECT_LT(law.tangent(1e-3), 100);
}

TEST(DepthLaw, WhereTheForceStaysTheSameTheLeastDepthIsItsDepth)
{
    DepthShape flat{.step = 0.1e-3};
    flat.tangents.fill(0);
    flat.tangents[0]   = 1;
    const DepthLaw law = DepthLaw::capped(200, 0, 1000, flat);
    EXPECT_NEAR(law.force(5e-3), 200 * 0.05e-3, 1e-12);
    EXPECT_NEAR(law.depthOf(law.force(5e-3)), 0.1e-3, 1e-6);
    EXPECT_TRUE(std::isfinite(law.depthOf(1)));
    flat.tangents.fill(1);
    flat.tangents[0] = 0; // it begins without a resistance
    EXPECT_EQ(DepthLaw::capped(200, 0, 1000, flat).depthOf(0), 0);
}

TEST(DepthShape, IsUsableIfItIsFiniteAndNeverFalls)
{
    EXPECT_TRUE(DepthShape{}.usable());
    EXPECT_TRUE(dome().usable());
    for (const double bad : {-0.1, std::nan(""), HUGE_VAL}) {
        DepthShape wrong  = dome();
        wrong.tangents[7] = bad;
        EXPECT_FALSE(wrong.usable());
        wrong      = dome();
        wrong.step = bad;
        EXPECT_FALSE(wrong.usable());
    }
}

TEST(DepthShape, BetweenTwoEverythingGoesEvenly)
{
    const DepthShape one = dome(), other = sheet();
    EXPECT_EQ(between(one, other, 0), one);
    EXPECT_EQ(between(one, other, 1), other);
    EXPECT_EQ(between(one, {}, 1), DepthShape{});
    EXPECT_EQ(between({}, other, 1), other);
    EXPECT_NEAR(between(one, other, 0.25).tangents[10], 0.75 * one.tangents[10] + 0.25 * other.tangents[10], 1e-12);
    EXPECT_NEAR(between({}, other, 0.5).tangents[8], 1.5, 1e-12); // none is a straight one
    EXPECT_NEAR(between(other, {}, 0.5).tangents[8], 1.5, 1e-12);
    EXPECT_EQ(between(other, {}, 0.5).step, other.step);
}

} // namespace
} // namespace palp
