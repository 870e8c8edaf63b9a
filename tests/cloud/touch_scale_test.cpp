#include "engine/cloud/touch_scale.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kSpacing = 5e-4; // [m]

double scaleInSpacings(double noiseInSpacings)
{
    return touchScale(noiseInSpacings * kSpacing, kSpacing) / kSpacing;
}

constexpr double kRounding = 1e-12; // three operations on doubles [spacings]

TEST(TouchScale, IsTheSpacingWhereThereIsHardlyAnyNoise)
{
    EXPECT_EQ(touchScale(0, kSpacing), kSpacing);
    EXPECT_EQ(touchScale(0.09 * kSpacing, kSpacing), kSpacing);
}

TEST(TouchScale, NeverFallsAsNoiseGrows)
{
    double last = 0;
    for (double noise = 0; noise < 5; noise += 0.01) {
        EXPECT_GE(scaleInSpacings(noise), last - kRounding) << "noise of " << noise << " spacings";
        last = scaleInSpacings(noise);
    }
}

TEST(TouchScale, FollowsTheMostNoiseThatTouchesAreHeldToAndStopsBeyond)
{
    EXPECT_NEAR(scaleInSpacings(2), 2 * kTouchScaleOfMuchNoise, kRounding) << "noise of 2 spacings is still averaged";
    EXPECT_NEAR(scaleInSpacings(3), 16, kRounding) << "a survey sees no surface in more";
    EXPECT_NEAR(scaleInSpacings(50), 16, kRounding);
}

} // namespace
} // namespace palp
