#include "engine/viewer/annotation.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/picture/cloud_shading.h"

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
