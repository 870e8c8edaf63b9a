
#include <gtest/gtest.h>

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

Image pictureOf(const GoldenCase& one, SurfaceRenderer& renderer)
{
    constexpr std::size_t kPoints = 4000;
    const Sample&         sample  = sampleNamed(one.sample);
    const SoftObject      object(makeSample(sample, kPoints, 1), sample.material);
    PatchSettings         settings;
    settings.foundation      = sample.foundation;
    settings.window          = sample.window;
    settings.footprintRadius = sample.footprintRadius;
    settings.cells           = 32;
    PlateSolver   host("host");
    const Contact contact = touchAt(object, sample.place, sample.from, settings.window / 4);
    const Patch   patch   = deform(object, contact, settings, host);
    TouchView     view(object, settings);
    view.show(&patch, forceThatShows(patch, sample.material.thickness), one.look);
    view.scene().title = std::string("sample:") + one.sample;
    const PictureSize size{320, 240, one.detail == Detail::fine ? 2 : 1, one.detail};
    Camera            camera = cameraAt(patch, double(size.width) / size.height);
    camera.projection        = one.projection;
    Image image              = renderer.draw(view.scene(), camera, size);
    annotate(image, view.scene(), camera);
    return image;
}

TEST_P(GoldenTest, ThePictureIsTheOneThatWasLookedAt)
{
    SurfaceRenderer renderer({.processor = processorOfTests(), .validation = validation()});
    expectGolden(PALPATE_GOLDEN, GetParam().file(), pictureOf(GetParam(), renderer), renderer);
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
