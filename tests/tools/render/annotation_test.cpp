#include "engine/tools/render/annotation.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/tools/plot/colour_map.h"

namespace palp {
namespace {

constexpr Rgb8 kGround{255, 255, 255};

std::size_t count(const Image& image, Rgb8 colour)
{
    return std::size_t(std::count(image.pixels.begin(), image.pixels.end(), colour));
}

TEST(Annotation, TheColourBarHasTheColoursOfTheSurface)
{
    const double value = 1;
    ViewScene    scene;
    scene.values  = {&value, 1};
    scene.colours = {ColourMap::cividis, Scale::linear, {0, 1e-3}, "deflection", "m"};
    Image image(640, 480, kGround);

    annotate(image, scene, {});

    int found = 0; // of a hundred shades of the map
    for (int n = 0; n < 100; ++n) found += count(image, surfaceColour((n + 0.5) / 100, ColourMap::cividis)) > 0;
    EXPECT_GT(found, 60);
    EXPECT_EQ(count(image, surfaceColour(0.5, ColourMap::viridis)), 0u);
}

TEST(Annotation, TwiceTheScaleIsTwiceTheSizeInTwiceThePicture)
{
    for (const int height : {150, 480, 720, 4000})
        EXPECT_DOUBLE_EQ(annotationSize(3 * height, 2 * height, 2), 2 * annotationSize(2 * height, height)) << height;
    EXPECT_EQ(annotationSize(640, 480, 2), 20) << "the least that can be read, at scale 2";
    EXPECT_EQ(annotationSize(600, 2000), annotationSize(2000, 600));
    ViewScene scene;
    scene.title = "a title";
    Image once(640, 480, kGround), twice(640, 480, kGround);
    annotate(once, scene, {});
    annotate(twice, scene, {}, 2);
    EXPECT_GT(double(count(twice, inkOn(scene.ground))), 2 * double(count(once, inkOn(scene.ground)))) << "darker";
}

TEST(Annotation, LaidOverAPictureItIsWhatItIsInThePicture)
{
    const double value = 1;
    ViewScene    scene;
    scene.values  = {&value, 1};
    scene.colours = {ColourMap::viridis, Scale::linear, {0, 1e-3}, "deflection", "m"};
    scene.proxy   = glm::dvec3(0);
    scene.title   = "a title";
    Image       image(330, 250, {200, 120, 40});
    const Image below = image;
    annotate(image, scene, {});
    const Overlay overlay = annotations(scene, {}, 330, 250);

    int                               most = 0, outside = 0; // difference, of 255; pixels in no tile
    const std::vector<std::uint32_t>& tiles = overlay.tiles;
    for (int y = 0; y < 250; ++y)
        for (int x = 0; x < 330; ++x) {
            const std::uint32_t pixel = overlay.pixels[std::size_t(y * 330 + x)];
            const auto          laid  = [&](int shift, int under) {
                return int(pixel >> shift & 255U) + (under * (255 - int(pixel >> 24)) + 127) / 255;
            };
            const Rgb8 under = below.at(x, y), is = image.at(x, y);
            most = std::max({most, std::abs(laid(0, under.red) - is.red), std::abs(laid(8, under.green) - is.green),
                             std::abs(laid(16, under.blue) - is.blue)});
            const auto tile = std::uint32_t(x / 32) | std::uint32_t(y / 32) << 16;
            outside += pixel != 0 && std::ranges::find(tiles, tile) == tiles.end();
        }
    EXPECT_LE(most, 3) << "three layers at most, each rounded once here and once there";
    EXPECT_EQ(outside, 0);
    EXPECT_LT(tiles.size(), 11U * 8U) << "the middle is left out";
}

TEST(Annotation, TheKeyNamesOnlyWhatIsThere)
{
    ViewScene scene;
    scene.proxy = glm::dvec3(0);
    Image image(640, 480, kGround);

    annotate(image, scene, {});

    EXPECT_GT(count(image, kProxyColour), 50u);
    EXPECT_EQ(count(image, kHipColour), 0u);
    EXPECT_EQ(count(image, kForceColour), 0u);
}

TEST(Annotation, ColoursThatGoOnEndInATip)
{
    const double value = 1;
    ViewScene    scene;
    scene.values          = {&value, 1};
    scene.colours         = {ColourMap::cividis, Scale::linear, {0, 1e-3}, "deflection", "m"};
    const auto ofTheTopIn = [&] {
        Image image(640, 480, kGround);
        annotate(image, scene, {});
        return count(image, surfaceColour(1, ColourMap::cividis));
    };
    const std::size_t plain = ofTheTopIn();
    scene.colours.goesOn    = true;
    EXPECT_GT(ofTheTopIn(), plain + 10);
}

TEST(Annotation, ALongNoteGoesOnInFurtherLinesAboveTheColours)
{
    const double value = 1;
    ViewScene    scene;
    scene.title       = "a title";
    scene.note        = "short";
    const auto lowest = [&](bool colours) { // row of ink, or of the middle of the map
        scene.values  = colours ? std::span(&value, 1) : std::span<const double>();
        scene.colours = {ColourMap::cividis, Scale::linear, {0, 1e-3},
                         "deflection",       "m",           true}; // the tip has the colour of 1
        Image image(320, 480, kGround);
        annotate(image, scene, {});
        const Rgb8 sought = colours ? surfaceColour(1, ColourMap::cividis) : inkOn(scene.ground);
        const auto last   = std::find(image.pixels.rbegin(), image.pixels.rend(), sought);
        return int(image.pixels.rend() - last) / 320;
    };
    const int once = lowest(false), bar = lowest(true);
    scene.note = "no force: The hand moved faster than 1.2 m/s. Hold it still, then start anew. R starts anew.";
    EXPECT_GE(lowest(false) - once, 15) << "a second line";
    EXPECT_GT(lowest(true), bar) << "the colours make room";
}

TEST(Annotation, InNarrowAndLowPicturesNothingIsCutOrCovered)
{
    const double     value = 1e-4;
    const glm::dvec3 point(0);
    ViewScene        scene;
    scene.title     = "stiffness_of_a_scanned_hand";
    scene.note      = "1.20 N, 0.73 mm deep, displacement \u00d7 8";
    scene.positions = {&point, 1};
    scene.proxy = scene.hip = glm::dvec3(0);
    scene.force = scene.normal = ViewSegment{{}, {0, 0, 1}};
    scene.outline              = {ViewSegment{}};
    for (const glm::ivec2 size :
         {glm::ivec2(200, 150), {240, 180}, {300, 225}, {320, 240}, {200, 900}, {300, 900}, {900, 200}}) {
        const auto drawn = [&](bool hasColours) {
            scene.values  = hasColours ? std::span(&value, 1) : std::span<const double>();
            scene.colours = {ColourMap::cividis, Scale::linear, {0, 1e-3}, "deflection", "m"};
            Image image(size.x, size.y, kGround);
            annotate(image, scene, {});
            return image;
        };
        const Image       with = drawn(true), without = drawn(false);
        const std::string where = std::to_string(size.x) + " x " + std::to_string(size.y);
        int               edge = 0, shades = 0;
        for (int y = 0; y < size.y; ++y) edge += with.at(size.x - 1, y) == inkOn(scene.ground);
        EXPECT_EQ(edge, 0) << "a text goes on beyond the picture, " << where;
        for (int n = 0; n < 100; ++n) shades += count(with, surfaceColour((n + 0.5) / 100, ColourMap::cividis)) > 0;
        const bool hasRoom = size.x > 250; // below two lines of a note
        EXPECT_TRUE(!hasRoom || shades > 30) << "the colours have a bar of 40 rows at least, " << where;
        // What others have drawn is there still, whole.
        int covered = 0;
        for (std::size_t n = 0; n < with.pixels.size(); ++n)
            covered += without.pixels[n] == inkOn(scene.ground) && with.pixels[n] != without.pixels[n];
        EXPECT_EQ(covered, 0) << where;
    }
}

TEST(Annotation, OnlyWhatHasPointsHasALength)
{
    const glm::dvec3 point(0);
    ViewScene        scene;
    Image            nothing(320, 240, kGround), something(320, 240, kGround);
    annotate(nothing, scene, {});
    scene.positions = {&point, 1};
    annotate(something, scene, {});

    EXPECT_EQ(count(nothing, kGround), nothing.pixels.size());
    EXPECT_GT(count(something, inkOn(scene.ground)), 0U);
}

TEST(Annotation, APictureTooSmallForTextsHasNone)
{
    ViewScene scene;
    scene.title = "title";
    Image image(100, 80, kGround);

    annotate(image, scene, {});

    EXPECT_EQ(count(image, kGround), image.pixels.size());
}

} // namespace
} // namespace palp
