#include "engine/picture/colour_map.h"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr ColourMap kMaps[] = {ColourMap::viridis, ColourMap::blueYellow, ColourMap::grey};

void expectNear(Rgb8 found, Rgb8 expected, int allowed, const char* because)
{
    EXPECT_LE(std::abs(found.red - expected.red), allowed) << because;
    EXPECT_LE(std::abs(found.green - expected.green), allowed) << because;
    EXPECT_LE(std::abs(found.blue - expected.blue), allowed) << because;
}

TEST(ColourMap, LightnessGrowsSteadilyAlongEveryMap)
{
    constexpr int kSteps = 64; // coarse enough that rounding to 8 bits (0.4 of L*) cannot hide a reversal
    for (ColourMap map : kMaps)
        for (int n = 0; n < kSteps; ++n) {
            const double step =
                lightness(colourAt(map, (n + 1.0) / kSteps)) - lightness(colourAt(map, double(n) / kSteps));
            EXPECT_GT(step, 0.3 * 75.0 / kSteps) << "map " << int(map) << " step " << n;
            EXPECT_LT(step, 2.5 * 100.0 / kSteps) << "map " << int(map) << " step " << n;
        }
}

TEST(ColourMap, ViridisFollowsThePublishedTableBetweenControlPoints)
{
    // Entries of the published table of 256.
    expectNear(colourAt(ColourMap::viridis, 0), {68, 1, 84}, 0, "first entry");
    expectNear(colourAt(ColourMap::viridis, 8.0 / 255), {71, 13, 96}, 2, "chord of a slightly curved piece");
    expectNear(colourAt(ColourMap::viridis, 128.0 / 255), {33, 145, 140}, 2, "chord of a slightly curved piece");
    expectNear(colourAt(ColourMap::viridis, 247.0 / 255), {234, 228, 26}, 8, "blue has its minimum inside this piece");
    expectNear(colourAt(ColourMap::viridis, 1), {253, 231, 37}, 0, "last entry");
}

TEST(ColourMap, BlueYellowDiffersInBlueAgainstYellowOnly)
{
    for (int n = 0; n <= 16; ++n) {
        const Rgb8 c = colourAt(ColourMap::blueYellow, n / 16.0);
        // Red and green together decide what a red-green colour-blind reader loses: they must not part.
        EXPECT_LT(std::abs(c.red - c.green), 60) << n;
    }
    const Rgb8 dark = colourAt(ColourMap::blueYellow, 0), light = colourAt(ColourMap::blueYellow, 1);
    EXPECT_GT(dark.blue, dark.green + 40);
    EXPECT_GT(light.green, light.blue + 80);
}

TEST(ColourMap, PositionsOutsideTakeTheEndColours)
{
    for (ColourMap map : kMaps) {
        EXPECT_EQ(colourAt(map, -3), colourAt(map, 0));
        EXPECT_EQ(colourAt(map, INFINITY), colourAt(map, 1));
        EXPECT_THROW((void)colourAt(map, NAN), ContractViolation);
    }
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

} // namespace
} // namespace palp
