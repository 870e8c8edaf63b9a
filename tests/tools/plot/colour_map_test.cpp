#include "engine/tools/plot/colour_map.h"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

double linearFromSrgb(double coded)
{
    return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

/// CIE lightness L* of a colour: 0 is black, 100 is white. [1]
double lightness(Rgb8 colour)
{
    const double y = 0.2126729 * linearFromSrgb(colour.red / 255.0) + 0.7151522 * linearFromSrgb(colour.green / 255.0) +
                     0.0721750 * linearFromSrgb(colour.blue / 255.0);
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

void expectNear(Rgb8 found, Rgb8 expected, int allowed, const char* because)
{
    EXPECT_LE(std::abs(found.red - expected.red), allowed) << because;
    EXPECT_LE(std::abs(found.green - expected.green), allowed) << because;
    EXPECT_LE(std::abs(found.blue - expected.blue), allowed) << because;
}

TEST(ColourMap, LightnessGrowsSteadily)
{
    constexpr int kSteps = 64; // coarse enough that rounding to 8 bits (0.4 of L*) cannot hide a reversal
    for (int n = 0; n < kSteps; ++n) {
        const double step = lightness(colourAt((n + 1.0) / kSteps)) - lightness(colourAt(double(n) / kSteps));
        EXPECT_GT(step, 0.3 * 75.0 / kSteps) << "step " << n;
        EXPECT_LT(step, 2.5 * 100.0 / kSteps) << "step " << n;
    }
}

TEST(ColourMap, ViridisFollowsThePublishedTableBetweenControlPoints)
{
    // Entries of the published table of 256.
    expectNear(colourAt(0), {68, 1, 84}, 0, "first entry");
    expectNear(colourAt(8.0 / 255), {71, 13, 96}, 2, "chord of a slightly curved piece");
    expectNear(colourAt(128.0 / 255), {33, 145, 140}, 2, "chord of a slightly curved piece");
    expectNear(colourAt(247.0 / 255), {234, 228, 26}, 8, "blue has its minimum inside this piece");
    expectNear(colourAt(1), {253, 231, 37}, 0, "last entry");
}

TEST(ColourMap, PositionsOutsideTakeTheEndColours)
{
    EXPECT_EQ(colourAt(-3), colourAt(0));
    EXPECT_EQ(colourAt(INFINITY), colourAt(1));
    EXPECT_THROW((void)colourAt(NAN), ContractViolation);
}

TEST(ColourMap, LightnessOfBlackGreyAndWhiteIsThatOfCie)
{
    EXPECT_NEAR(lightness({0, 0, 0}), 0, 1e-9);
    EXPECT_NEAR(lightness({119, 119, 119}), 50.0, 0.1) << "sRGB 119 is L* 50.03";
    EXPECT_NEAR(lightness({255, 255, 255}), 100, 0.01) << "the luminance weights sum to 1";
}

TEST(ColourMap, HexColourHasTwoDigitsEach)
{
    EXPECT_EQ(hexColour({1, 171, 255}), "#01abff");
}

TEST(ColourMap, EveryMapRisesInLightnessAndHasANameOfItsOwn)
{
    for (const ColourMap map : {ColourMap::viridis, ColourMap::cividis, ColourMap::grey}) {
        EXPECT_EQ(valueNamed<ColourMap>(name(map)), map);
        double last = -1;
        for (int n = 0; n <= 200; ++n) {
            const double now = lightness(colourAt(n / 200.0, map));
            EXPECT_GE(now, last - 0.4) << name(map) << " at " << n / 200.0 << ": bytes round";
            last = now;
        }
    }
    EXPECT_EQ(valueNamed<ColourMap>("jet"), std::nullopt);
    EXPECT_NE(colourAt(0.5, ColourMap::cividis), colourAt(0.5));
}

} // namespace
} // namespace palp
