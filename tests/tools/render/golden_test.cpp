#include <array>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include "engine/cloud/mesh_points.h"
#include "engine/cloud/samples.h"
#include "engine/pipeline/deform.h"
#include "engine/tools/render/annotation.h"
#include "engine/tools/render/surface_renderer.h"
#include "engine/tools/render/touch_view.h"
#include "tests/support/golden_picture.h"
#include "tests/support/shader_fixture.h"

// Whole pictures, texts included, compared as tests/support/golden_picture.h says.

namespace palp {
namespace {

struct GoldenCase {
    const char* sample;
    TouchLook   look;
    Projection  projection = Projection::perspective;
    Detail      detail     = Detail::fine;

    [[nodiscard]] std::string file() const
    {
        return std::string(sample) + (detail == Detail::fast ? "-fast.png" : ".png");
    }
};

void PrintTo(const GoldenCase& one, std::ostream* stream)
{
    *stream << one.sample << " " << name(one.look.paint);
}

class GoldenTest : public ShaderTest, public ::testing::WithParamInterface<GoldenCase> {};

/// A touch of an object.
struct Touched {
    SoftObject                object;
    PatchSettings             settings{};
    glm::dvec3                place{};
    std::optional<glm::dvec3> from{};
};

Image pictureOf(const Touched& touched, const GoldenCase& one, const std::string& title, SurfaceRenderer& renderer)
{
    const SoftObject& object = touched.object;
    PlateSolver       host("host");
    const Contact     contact = touchAt(object, touched.place, touched.from, touched.settings.window / 4);
    const Patch       patch   = deform(object, contact, touched.settings, host);
    TouchView         view(object, touched.settings);
    view.show(&patch, forceThatShows(patch, object.material().thickness), one.look);
    view.scene().title = title;
    const PictureSize size{320, 240, one.detail == Detail::fine ? 2 : 1, one.detail};
    Camera            camera = cameraAt(patch, double(size.width) / size.height);
    camera.projection        = one.projection;
    Image image              = renderer.draw(view.scene(), camera, size);
    annotate(image, view.scene(), camera);
    return image;
}

Image pictureOf(const GoldenCase& one, SurfaceRenderer& renderer)
{
    constexpr std::size_t kPoints = 4000;
    const Sample&         sample  = sampleNamed(one.sample);
    Touched touched{SoftObject(makeSample(sample, kPoints, 1), sample.material), {}, sample.place, sample.from};
    touched.settings.foundation      = sample.foundation;
    touched.settings.window          = sample.window;
    touched.settings.footprintRadius = sample.footprintRadius;
    touched.settings.cells           = 32;
    return pictureOf(touched, one, std::string("sample:") + one.sample, renderer);
}

/// A box of 8 corners and 12 triangles, 60 x 60 x 20 mm, ten times as stiff at one end, touched on its large face.
Touched meshBox()
{
    SurfaceMesh         box;
    std::vector<double> stiffness; // [Pa] of the vertices
    for (int n = 0; n < 8; ++n) {
        const bool right = (n & 1) != 0, far = (n & 2) != 0, high = (n & 4) != 0;
        box.vertices.emplace_back(right ? 30e-3 : -30e-3, far ? 30e-3 : -30e-3, high ? 0 : -20e-3);
        stiffness.push_back(right ? 1e6 : 1e5);
    }
    constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& [a, b, c, d] : kSides) {
        box.faces.push_back({a, b, c});
        box.faces.push_back({a, c, d});
    }
    const MeshPoints             points = scatterOver(box.vertices, box.faces, {.distance = 1e-3});
    const std::vector<glm::vec3> normals(points.normals.begin(), points.normals.end());
    Material                     material;
    material.thickness = 2e-3;
    Touched touched{
        SoftObject(PointCloud(points.positions, logInterpolated(points, box.faces, stiffness), StiffnessKind::modulus),
                   material, {}, normals)
            .standingFor(box),
        {},
        {5e-3, 4e-3, 0},
        glm::dvec3(0, 0, 1)};
    touched.settings.foundation      = 5e5;
    touched.settings.window          = 40e-3;
    touched.settings.footprintRadius = 3e-3;
    touched.settings.cells           = 32;
    return touched;
}

TEST_P(GoldenTest, ThePictureIsTheOneThatWasLookedAt)
{
    SurfaceRenderer renderer({.processor = processorOfTests(), .validation = validation()});
    expectGolden(PALPATE_GOLDEN, GetParam().file(), pictureOf(GetParam(), renderer), renderer);
}

class GoldenMesh : public ShaderTest {};

TEST_F(GoldenMesh, TheFacesOfAFileAreDrawnAndBent)
{
    SurfaceRenderer  renderer({.processor = processorOfTests(), .validation = validation()});
    const GoldenCase look{"box", {ViewPaint::stiffness, ColourMap::cividis, Ground::light, 4}};
    expectGolden(PALPATE_GOLDEN, "mesh-box.png", pictureOf(meshBox(), look, "a box of 12 triangles", renderer),
                 renderer);
}

/// A hand whose device senses how it is turned: the stylus leans away from the normal by a third of a right angle, and
/// its button shows how it is rolled. Untilted it looks otherwise.
TEST_F(GoldenMesh, TheStylusIsDrawnWithItsTilt)
{
    SurfaceRenderer renderer({.processor = processorOfTests(), .validation = validation()});
    const Touched   touched = meshBox();
    PlateSolver     host("host");
    const Contact   contact = touchAt(touched.object, touched.place, touched.from, touched.settings.window / 4);
    const Patch     patch   = deform(touched.object, contact, touched.settings, host);
    TouchView       view(touched.object, touched.settings);
    const auto      drawn = [&](const std::optional<glm::dquat>& turn) {
        const double force = forceThatShows(patch, touched.object.material().thickness);
        view.show(&patch, force, {}, TouchHand{contact.point, {0, 0, force}, contact.point, turn});
        view.scene().title = "a stylus";
        const PictureSize size{320, 240, 2};
        const Camera      camera = cameraAt(patch, double(size.width) / size.height);
        Image             image  = renderer.draw(view.scene(), camera, size);
        annotate(image, view.scene(), camera);
        return image;
    };
    const Image upright = drawn(glm::dquat(1, 0, 0, 0));
    const Image tilted  = drawn(glm::angleAxis(0.52, glm::dvec3(0, 1, 0)));
    EXPECT_NE(tilted.pixels, upright.pixels);
    EXPECT_NE(drawn({}).pixels, upright.pixels) << "without a turn there is no stylus";
    expectGolden(PALPATE_GOLDEN, "stylus.png", tilted, renderer);
}

INSTANTIATE_TEST_SUITE_P(
    Samples, GoldenTest,
    ::testing::Values(GoldenCase{"skin", {}}, GoldenCase{"palm", {ViewPaint::stiffness, ColourMap::cividis}},
                      GoldenCase{"ear-lobe", {ViewPaint::deflection, ColourMap::viridis, Ground::dark}},
                      GoldenCase{"ellipsoid", {ViewPaint::plain, ColourMap::viridis, Ground::light, 2}},
                      GoldenCase{"sheet", {ViewPaint::deflection, ColourMap::grey}, Projection::orthographic},
                      GoldenCase{"palm", {ViewPaint::stiffness}, Projection::perspective, Detail::fast},
                      GoldenCase{"ear-lobe", {ViewPaint::deflection}, Projection::orthographic, Detail::fast}));

} // namespace
} // namespace palp
