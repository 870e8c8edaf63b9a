#include "engine/tools/render/surface_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cloud/neighbour_index.h"
#include "engine/tools/render/annotation.h"
#include "engine/tools/render/cloud_skin.h"
#include "tests/support/shader_fixture.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// A square sheet seen from above, 100 mm wide.
struct Sheet {
    explicit Sheet(int side = 60, double dent = 0)
    {
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const double x = 0.1 * (i + 0.5) / side - 0.05, y = 0.1 * (j + 0.5) / side - 0.05; // [m]
                positions.emplace_back(x, y, -dent * std::exp(-(x * x + y * y) / (2 * 0.01 * 0.01)));
            }
        const NeighbourIndex index(positions);
        const CloudSkin      skin(positions, index);
        normals = skin.normals(positions);
        radii.assign(skin.radii().begin(), skin.radii().end());
        cores.assign(skin.cores().begin(), skin.cores().end());
    }
    [[nodiscard]] ViewScene scene() const
    {
        ViewScene scene;
        scene.positions = positions;
        scene.normals   = normals;
        scene.radii     = radii;
        scene.cores     = cores;
        scene.cueRadius = 0.007;
        return scene;
    }
    std::vector<glm::dvec3> positions, normals; // [m], [1]
    std::vector<double>     radii, cores;       // [m]
};

/// From above, the sheet fills the height of the picture.
Camera above()
{
    Camera camera;
    camera.distance = 0.05 / std::tan(kFieldOfView / 2) * 1.2;
    return camera;
}

int brightness(Rgb8 colour)
{
    return int(colour.red) + int(colour.green) + int(colour.blue);
}

/// What holds for fine pictures and for fast ones.
class SurfaceRendererTest : public ShaderTest, public ::testing::WithParamInterface<Detail> {
protected:
    void SetUp() override
    {
        if (onHost()) GTEST_SKIP() << "the host does not draw";
        ShaderTest::SetUp();
        renderer.emplace(compute::ContextSettings{.processor = processorOfTests(), .validation = validation()});
    }
    void TearDown() override
    {
        if (renderer)
            for (const std::string& message : renderer->takeMessages()) ADD_FAILURE() << "validation: " << message;
        renderer.reset();
        ShaderTest::TearDown();
    }
    const PictureSize              small{96, 72, 1, GetParam()};
    std::optional<SurfaceRenderer> renderer;
};

INSTANTIATE_TEST_SUITE_P(Details, SurfaceRendererTest, ::testing::Values(Detail::fine, Detail::fast),
                         [](const auto& param) { return param.param == Detail::fine ? "fine" : "fast"; });

TEST_P(SurfaceRendererTest, NothingIsTheGround)
{
    ViewScene   scene;
    const Image light = renderer->draw(scene, {}, small);
    scene.ground      = Ground::dark;
    const Image dark  = renderer->draw(scene, {}, small);

    EXPECT_GT(brightness(light.at(48, 36)), 3 * 220);
    EXPECT_LT(brightness(dark.at(48, 36)), 3 * 60);
}

TEST_P(SurfaceRendererTest, ASheetHasNoHolesAndEndsWhereItsPointsEnd)
{
    const Sheet sheet;
    const Image image = renderer->draw(sheet.scene(), above(), small);
    const Image empty = renderer->draw({}, above(), small);

    int inside = 0, outside = 0; // pixels that differ from what belongs there
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double halfHeight = above().halfHeight() / (image.height / 2.0); // [m/px]
            const double away       = std::max(std::abs(x + 0.5 - 48), std::abs(y + 0.5 - 36)) * halfHeight;
            const bool   drawn      = image.at(x, y) != empty.at(x, y);
            inside += away < 0.049 && !drawn;
            outside += away > 0.056 && drawn;
        }
    EXPECT_EQ(inside, 0) << "holes";
    EXPECT_EQ(outside, 0) << "beyond the border by more than a few spacings";
}

/// Points of a picture have a largest size, here of 255 pixels, as on some GPUs.
TEST_P(SurfaceRendererTest, DiscsLargerThanAPointCanBeLeaveNoHoles)
{
    const Sheet sheet(12);
    Camera      near = above();
    near.distance *= 0.02;
    const PictureSize size{640, 480, 1, GetParam()};
    const Image       image = renderer->draw(sheet.scene(), near, size), empty = renderer->draw({}, near, size);

    int holes = 0;
    for (std::size_t n = 0; n < image.pixels.size(); ++n) holes += image.pixels[n] == empty.pixels[n];
    EXPECT_EQ(holes, 0);
}

TEST_P(SurfaceRendererTest, AnObjectTenThousandTimesAsSmallLooksTheSame)
{
    Sheet sheet(40, 2e-3);
    for (std::size_t n = 0; n < sheet.positions.size(); ++n) // rough, so that discs lie behind others
        sheet.positions[n].z += 1e-3 * std::sin(37.0 * double(n));
    Camera            camera = orbited(above(), {0.4, 1.2});
    const PictureSize size{160, 120, 1, GetParam()};
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        camera.projection  = projection;
        const Image large  = renderer->draw(sheet.scene(), camera, size);
        Sheet       shrunk = sheet;
        for (glm::dvec3& place : shrunk.positions) place *= 1e-4;
        for (double& radius : shrunk.radii) radius *= 1e-4;
        for (double& core : shrunk.cores) core *= 1e-4;
        ViewScene scene = shrunk.scene();
        scene.cueRadius *= 1e-4;
        Camera near = camera;
        near.distance *= 1e-4;
        const Image tiny = renderer->draw(scene, near, size);
        int         most = 0; // of 765
        for (std::size_t n = 0; n < large.pixels.size(); ++n)
            most = std::max(most, std::abs(brightness(large.pixels[n]) - brightness(tiny.pixels[n])));
        EXPECT_LE(most, 6) << "two of 255 a colour: rounding of single precision";
    }
}

TEST_P(SurfaceRendererTest, TheSamePictureTwiceIsTheSameToTheBit)
{
    const Sheet sheet(60, 2e-3);
    const Image first = renderer->draw(sheet.scene(), above(), small);
    (void)renderer->draw({}, above(), {40, 50, 2, GetParam()}); // other sizes and buffers in between
    EXPECT_EQ(renderer->draw(sheet.scene(), above(), small).pixels, first.pixels);
}

/// Pictures of a touch that goes on, each drawn over the one before, are those of a renderer that begins anew.
TEST_P(SurfaceRendererTest, APictureDrawnOverTheOneBeforeIsTheOneDrawnAnew)
{
    SurfaceRenderer   anew({.processor = processorOfTests(), .validation = validation()});
    const PictureSize size{160, 120, 1, GetParam()};
    const Triangle    faces[] = {{0, 59, 3540}, {59, 3540, 3599}, {100, 1900, 2000}};
    for (int step = 0; step < 24; ++step) {
        const Sheet  sheet(60, 1e-3 * (step / 4)); // four are alike but for the hand
        ViewScene    scene = sheet.scene();
        const double x     = 0.003 * step - 0.03; // [m]
        scene.hip = scene.proxy = glm::dvec3(x, 0.01, 0.002);
        scene.markerRadius      = 0.003;
        scene.arrowRadius       = 0.0005;
        if (step % 3) scene.force = ViewSegment{{x, 0.01, 0}, {x, 0.01, 0.03}};
        if (step % 4 == 1) scene.dots = {{{-x, 0.03, 0.001}, 0.001, kHipColour}, {{x, -0.03, 0.001}, 1e-5, kHipColour}};
        if (step % 7 == 6) scene.ground = Ground::dark;
        if (step > 18) scene.faces = faces;
        Camera camera = above();
        if (step > 12) camera = orbited(camera, {0.4, 1.2}); // a point's square is wider than its disc, seen aslant
        if (step == 16) camera.projection = Projection::orthographic;
        if (step % 6 != 5) scene.title = step % 2 ? "one" : "another one";
        const Overlay texts = annotations(scene, camera, size.width, size.height);

        const Image over = renderer->draw(scene, camera, size, step % 11 == 10 ? nullptr : &texts);
        (void)anew.draw({}, {}, {8, 8});
        EXPECT_EQ(over.pixels, anew.draw(scene, camera, size, step % 11 == 10 ? nullptr : &texts).pixels) << step;
    }
    for (const std::string& message : anew.takeMessages()) ADD_FAILURE() << "validation: " << message;
}

TEST_P(SurfaceRendererTest, ADentOfAHundredthOfTheObjectIsPlainlyVisible)
{
    const Image flat = renderer->draw(Sheet(60).scene(), above(), small);
    const Image bent = renderer->draw(Sheet(60, 1e-3).scene(), above(), small);

    int most = 0; // difference of a pixel, of 3 * 255
    for (std::size_t n = 0; n < flat.pixels.size(); ++n)
        most = std::max(most, std::abs(brightness(flat.pixels[n]) - brightness(bent.pixels[n])));
    EXPECT_GT(most, 3 * 20) << "as much as between neighbouring steps of a scale of twelve greys";
}

TEST_P(SurfaceRendererTest, AHollowWithoutASlopeIsDarkerAndAHumpLighter)
{
    const Sheet sheet;
    const auto  brightnessWith = [&](double hollow) {
        ViewScene                 scene = sheet.scene();
        const std::vector<double> hollows(sheet.positions.size(), hollow);
        scene.hollows = hollows;
        return brightness(renderer->draw(scene, above(), small).at(48, 36));
    };
    if (GetParam() == Detail::fine) {
        EXPECT_EQ(brightnessWith(0.05), brightnessWith(0)) << "seen in the depths, where there is none";
    } else {
        EXPECT_LT(brightnessWith(0.05), brightnessWith(0) - 3 * 5);
        EXPECT_GT(brightnessWith(-0.05), brightnessWith(0) + 3 * 5);
    }
}

TEST_P(SurfaceRendererTest, WhatIsNearerHidesWhatIsBehind)
{
    Sheet               sheet;
    std::vector<double> values(sheet.positions.size(), 0);
    const std::size_t   count = sheet.positions.size();
    for (std::size_t n = 0; n < count; ++n) { // a second sheet, 10 mm above, comes later
        sheet.positions.push_back(sheet.positions[n] + glm::dvec3(0, 0, 0.01));
        sheet.normals.push_back(sheet.normals[n]);
        sheet.radii.push_back(sheet.radii[n]);
        sheet.cores.push_back(sheet.cores[n]);
        values.push_back(1);
    }
    ViewScene scene  = sheet.scene();
    scene.values     = values;
    const Rgb8 over  = renderer->draw(scene, above(), small).at(48, 36);
    Camera     below = above();
    below.toEye      = {0, 0, -1};
    const Rgb8 under = renderer->draw(scene, below, small).at(48, 36);

    EXPECT_GT(over.red, over.blue) << "yellow, the upper sheet";
    EXPECT_GT(under.blue, under.green) << "violet, the lower one";
}

TEST_P(SurfaceRendererTest, AHiddenHipShinesThroughAndTheOneInFrontIsOpaque)
{
    const Sheet sheet;
    ViewScene   scene  = sheet.scene();
    const Rgb8  bare   = renderer->draw(scene, above(), small).at(48, 36);
    scene.markerRadius = 0.005;
    scene.hip          = glm::dvec3(0, 0, -0.02);
    const Rgb8 behind  = renderer->draw(scene, above(), small).at(48, 36);
    scene.hip          = glm::dvec3(0, 0, 0.02);
    const Rgb8 before  = renderer->draw(scene, above(), small).at(48, 36);

    EXPECT_NE(behind, bare);
    EXPECT_NE(behind, before);
    const auto hue = [](Rgb8 c) { return int(c.red) - int(c.green); }; // of reddish purple
    EXPECT_GT(hue(before), hue(behind));
    EXPECT_GT(hue(behind), hue(bare));
}

TEST_P(SurfaceRendererTest, AStrokeOfCurvatureBehindTheSurfaceIsHidden)
{
    const Sheet sheet;
    ViewScene   scene   = sheet.scene();
    const Image bare    = renderer->draw(scene, above(), small);
    scene.outlineRadius = 0.002;
    const auto drawn    = [&](double height) {
        scene.bulging = {{{-0.02, 0, height}, {0.02, 0, height}}};
        scene.hollow  = {{{0, -0.02, height}, {0, 0.02, height}}};
        return renderer->draw(scene, above(), small);
    };

    EXPECT_EQ(drawn(-0.01).pixels, bare.pixels);
    EXPECT_NE(drawn(0.01).pixels, bare.pixels);
}

TEST_P(SurfaceRendererTest, AValueWithoutAColourIsGrey)
{
    const Sheet               sheet;
    const std::vector<double> values(sheet.positions.size(), std::nan(""));
    ViewScene                 scene = sheet.scene();
    scene.values                    = values;
    const Rgb8 colour               = renderer->draw(scene, above(), small).at(48, 36);

    EXPECT_NEAR(colour.red, colour.green, 3);
    EXPECT_NEAR(colour.blue, colour.green, 3);
}

TEST_P(SurfaceRendererTest, AnOrthographicEyeSeesTheSameSizeAtTheTarget)
{
    const Sheet sheet;
    const Image near = renderer->draw(sheet.scene(), above(), small);
    const Image far  = renderer->draw(sheet.scene(), otherProjection(above()), small);
    const Image none = renderer->draw({}, above(), small);
    const auto  area = [&](const Image& image) {
        int pixels = 0;
        for (std::size_t n = 0; n < image.pixels.size(); ++n) pixels += image.pixels[n] != none.pixels[n];
        return pixels;
    };
    EXPECT_NEAR(area(near), area(far), 0.03 * area(near));
}

TEST_P(SurfaceRendererTest, APictureLargerThanTheDeviceDrawsIsRefusedWithItsBound)
{
    const std::string sentence = refusalOf([&] { (void)renderer->draw({}, {}, {1 << 20, 8, 1}); });
    EXPECT_TRUE(holds(sentence, {"1048576 x 8", "larger than"})) << sentence;
    EXPECT_EQ(renderer->draw({}, {}, small).width, small.width) << "and it still draws";
}

TEST_P(SurfaceRendererTest, TheHostIsRefused)
{
    EXPECT_TRUE(holds(refusalOf([] { SurfaceRenderer({.processor = "host"}); }), {"cannot draw", "lavapipe"}));
}

} // namespace
} // namespace palp
