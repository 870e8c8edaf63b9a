#include "engine/tools/render/text.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace palp {
namespace {

/// Leftmost and rightmost column with ink, and how much there is.
struct Ink {
    int left = 1 << 20, right = -1, pixels = 0;
};

Ink inkOf(const Image& image)
{
    Ink ink;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.at(x, y) != Rgb8{255, 255, 255}) {
                ink.left  = std::min(ink.left, x);
                ink.right = std::max(ink.right, x);
                ++ink.pixels;
            }
    return ink;
}

TEST(Text, IsAsWideAsItSays)
{
    Image image(400, 60);
    drawText(image, {50, 40}, "deflection [mm]", {24});
    const Ink ink = inkOf(image);
    EXPECT_NEAR(ink.left, 50, 4);
    EXPECT_NEAR(ink.right, 50 + widthOfText("deflection [mm]", 24), 4);
}

TEST(Text, EndsOrCentresWhereItIsTold)
{
    Image end(400, 60), middle(400, 60);
    drawText(end, {300, 40}, "HIP", {24, {0, 0, 0}, Anchor::end});
    drawText(middle, {200, 40}, "HIP", {24, {0, 0, 0}, Anchor::middle});
    EXPECT_NEAR(inkOf(end).right, 300, 4);
    EXPECT_NEAR((inkOf(middle).left + inkOf(middle).right) / 2, 200, 3);
}

TEST(Text, HasTheSignsOfUnits)
{
    Image missing(100, 60);
    drawText(missing, {30, 40}, "\uE000", {24}); // nobody's character: the font's box
    for (const char* sign : {"\u00b5", "\u2212", "\u00d7", "\u00b2", "\u207b", "\u2074"}) {
        Image image(100, 60);
        drawText(image, {30, 40}, sign, {24});
        EXPECT_GT(inkOf(image).pixels, 0) << sign;
        EXPECT_NE(image.pixels, missing.pixels) << sign << " is not in the font";
    }
}

TEST(Text, IsCutOffAtThePictureAndTakesAnyBytes)
{
    Image image(20, 10);
    drawText(image, {-30, 5}, "far too long for such a picture", {24});
    drawText(image, {1e4, -1e4}, "elsewhere", {24});
    drawText(image, {0, 8}, "\xff\xc3", {8});
    SUCCEED();
}

} // namespace
} // namespace palp
