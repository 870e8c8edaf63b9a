#include "tests/support/golden_picture.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "engine/tools/render/text.h"

// The comparison of pictures must find some differences and let others pass.

namespace palp {
namespace {

/// Draws a picture of 320 x 240, as the smallest of the stored ones, with a ramp, a bar of one colour and a text.
Image picture(const std::string& text = "1.25 N at 60 Hz", int shift = 0)
{
    Image image(320, 240);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto level = std::uint8_t(40 + (x + y) / 4);
            image.at(x, y)   = {level, std::uint8_t(level / 2), 90};
        }
    for (int y = 100; y < 140; ++y)
        for (int x = 200; x < 240; ++x) image.at(x + shift, y) = {200, 120, 40};
    drawText(image, {20, 40}, text, {.size = 12, .colour = {235, 235, 235}});
    return image;
}

constexpr std::size_t kAllowed = 320 * 240 / 1000;

TEST(GoldenPicture, AFewPixelsOfLastBitsPass)
{
    Image rounded = picture();
    for (std::size_t n = 0; n < kAllowed; ++n) rounded.pixels[n * 997].red += 3;
    EXPECT_TRUE(looksLike(rounded, picture()));
    EXPECT_EQ(differenceOf(rounded, picture()).pixels, kAllowed);
    EXPECT_EQ(differenceOf(rounded, picture()).levels, 3);
}

TEST(GoldenPicture, OnePixelMoreFails)
{
    Image rounded = picture();
    for (std::size_t n = 0; n <= kAllowed; ++n) rounded.pixels[n * 997].blue += 1;
    EXPECT_FALSE(looksLike(rounded, picture()));
}

TEST(GoldenPicture, AnEdgeThroughThePixelsOfATiePassesAndAPixelMoreFails)
{
    Image tied = picture();
    for (std::size_t n = 0; n < kGoldenStrays; ++n) tied.at(17, int(n) * 19).green += 25;
    EXPECT_TRUE(looksLike(tied, picture()));
    EXPECT_EQ(differenceOf(tied, picture()).strays, kGoldenStrays);
    Image many = tied, far = tied;
    many.at(18, 203).green -= 4; // a level more than may differ, in one pixel more
    EXPECT_FALSE(looksLike(many, picture()));
    far.at(17, 0).green = std::uint8_t(picture().at(17, 0).green + kGoldenStrayLevels + 1);
    EXPECT_FALSE(looksLike(far, picture()));
}

TEST(GoldenPicture, AShapeThatMovedByOnePixelFails)
{
    EXPECT_FALSE(looksLike(picture("1.25 N at 60 Hz", 1), picture()));
}

TEST(GoldenPicture, AColourEightLevelsOffFails)
{
    Image other = picture();
    for (int x = 200; x < 209; ++x) other.at(x, 110).green += 8; // nine pixels are enough
    EXPECT_FALSE(looksLike(other, picture()));
}

TEST(GoldenPicture, EverythingOneLevelBrighterFails)
{
    Image other = picture();
    for (Rgb8& pixel : other.pixels) ++pixel.red;
    EXPECT_FALSE(looksLike(other, picture()));
}

TEST(GoldenPicture, AMissingCharacterFails)
{
    EXPECT_FALSE(looksLike(picture("1.25 N at 60 H"), picture()));
    EXPECT_FALSE(looksLike(picture("125 N at 60 Hz"), picture())); // a full stop
    EXPECT_FALSE(looksLike(picture("1.26 N at 60 Hz"), picture()));
    EXPECT_FALSE(looksLike(picture("1.25 N at 60 Hz."), picture())); // one behind all others
}

TEST(GoldenPicture, AnotherSizeFails)
{
    EXPECT_FALSE(looksLike(Image(319, 240), Image(320, 240)));
    EXPECT_FALSE(looksLike(Image(240, 320), Image(320, 240)));
}

} // namespace
} // namespace palp
