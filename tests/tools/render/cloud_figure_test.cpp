#include "engine/tools/render/cloud_figure.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/pipeline/deform.h"
#include "tests/support/shader_fixture.h"
#include "tests/tools/plot/svg_reader.h"

namespace palp {
namespace {

class CloudFigureTest : public ShaderTest {
protected:
    void SetUp() override
    {
        if (onHost()) GTEST_SKIP() << "the host does not draw";
        ShaderTest::SetUp();
    }
};

/// Draws a figure with a renderer of its own.
std::string figureSvg(std::span<const glm::dvec3> rest, std::span<const glm::dvec3> now, std::span<const double> values,
                      const CloudFigure& figure)
{
    FigureRenderer renderer;
    return cloudFigureSvg(rest, now, values, figure, renderer);
}

/// A square sheet, 100 mm wide, whose points have their x as a value [m].
struct Sheet {
    explicit Sheet(int side = 60)
    {
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                positions.emplace_back(0.1 * (i + 0.5) / side - 0.05, 0.1 * (j + 0.5) / side - 0.05, 0);
                values.push_back(positions.back().x);
            }
    }
    [[nodiscard]] Image drawn(const CloudFigure& figure) const
    {
        return test::embeddedImage(figureSvg(positions, positions, values, figure));
    }
    std::vector<glm::dvec3> positions; // [m]
    std::vector<double>     values;    // [m]
};

CloudFigure fromAbove()
{
    CloudFigure figure;
    figure.direction = {0, 0, -1};
    return figure;
}

bool grey(Rgb8 colour)
{
    return std::abs(int(colour.red) - int(colour.green)) < 12 && std::abs(int(colour.green) - int(colour.blue)) < 12;
}

TEST_F(CloudFigureTest, TheWholeCloudFitsAndFillsTheFigure)
{
    const Image image  = Sheet().drawn(fromAbove());
    const int   middle = image.width / 2;

    ASSERT_EQ(image.width, 900);
    ASSERT_EQ(image.height, 700);
    EXPECT_TRUE(grey(image.at(middle, 8))) << "the ground";
    EXPECT_TRUE(grey(image.at(middle, image.height - 8)));
    EXPECT_FALSE(grey(image.at(middle, 60))) << "the sheet takes most of the height";
    EXPECT_FALSE(grey(image.at(middle, image.height - 60)));
}

TEST_F(CloudFigureTest, AWindowShowsItsCentreInTheMiddle)
{
    const Sheet sheet;
    CloudFigure figure = fromAbove();
    figure.window      = FigureWindow{{0.03, 0, 0}, 0.01};
    const Image right  = sheet.drawn(figure);
    figure.window      = FigureWindow{{-0.03, 0, 0}, 0.01};
    const Image left   = sheet.drawn(figure);

    const Rgb8 high = right.at(450, 350), low = left.at(450, 350);
    EXPECT_GT(int(high.green), int(low.green) + 40) << "viridis goes from violet to yellow";
    EXPECT_FALSE(grey(right.at(20, 350))) << "nothing but the sheet is in the window";
}

TEST_F(CloudFigureTest, AValueLooksAlmostTheSameOnEverySlope)
{
    std::vector<glm::dvec3> dome; // the upper half of a ball of 50 mm
    for (int n = 0; n < 4000; ++n) {
        const double z = (n + 0.5) / 4000, angle = 2.399963 * n, aside = std::sqrt(1 - z * z);
        dome.emplace_back(0.05 * aside * std::cos(angle), 0.05 * aside * std::sin(angle), 0.05 * z);
    }
    const std::vector<double> values(dome.size(), 1.0);
    CloudFigure               figure = fromAbove();
    figure.range                     = ValueRange{0, 2};
    const auto contrast              = [&] {
        const Image image = test::embeddedImage(figureSvg(dome, dome, values, figure));
        int         least = 255, most = 0;
        for (int n = 0; n < 24; ++n) { // half way down to the rim
            const double angle  = n * 0.2618;
            const Rgb8   colour = image.at(450 + int(200 * std::cos(angle)), 350 + int(200 * std::sin(angle)));
            least               = std::min(least, int(colour.green));
            most                = std::max(most, int(colour.green));
        }
        return double(most) / least;
    };

    EXPECT_LT(contrast(), 1.3) << "1.07 to 0.85";
    figure.evenLight = 0;
    EXPECT_GT(contrast(), 1.4) << "in the light that shows shapes";
}

TEST_F(CloudFigureTest, PointsWithoutAValueAreGrey)
{
    Sheet sheet;
    for (double& value : sheet.values)
        if (value > 0) value = NAN;
    const Image image = sheet.drawn(fromAbove());

    EXPECT_TRUE(grey(image.at(550, 350)));
    EXPECT_FALSE(grey(image.at(350, 350)));
    EXPECT_TRUE(test::hasText(figureSvg(sheet.positions, sheet.positions, sheet.values, fromAbove()),
                              "1800 points without a value are grey."));
}

TEST_F(CloudFigureTest, WhatHasNoSurfaceIsASentence)
{
    const std::vector<glm::dvec3> same(20, glm::dvec3(1, 2, 3));
    const std::vector<double>     values(20, 1.0);
    CloudFigure                   figure;
    figure.title = "A speck";

    for (const std::size_t count : {std::size_t(0), std::size_t(3), same.size()}) {
        const std::span<const glm::dvec3> points(same.data(), count);
        const std::string                 svg = figureSvg(points, points, std::span(values).first(count), figure);
        EXPECT_TRUE(test::elementsOf(svg, "image").empty());
        EXPECT_NE(svg.find("this picture could not be drawn"), std::string::npos) << svg;
        EXPECT_TRUE(test::hasText(svg, "A speck"));
    }
}

TEST_F(CloudFigureTest, TheSameFigureTwiceIsTheSameToTheByte)
{
    const Sheet sheet(20);
    const auto  fresh = [&] { return figureSvg(sheet.positions, sheet.positions, sheet.values, fromAbove()); };
    EXPECT_EQ(fresh(), fresh());

    FigureRenderer kept;
    const auto     next = [&](const Sheet& what) {
        return cloudFigureSvg(what.positions, what.positions, what.values, fromAbove(), kept);
    };
    const SurfaceRenderer* const first = &kept.opened();
    static_cast<void>(next(Sheet(30)));
    EXPECT_EQ(next(sheet), fresh()) << "a renderer that has drawn another figure";
    EXPECT_EQ(&kept.opened(), first) << "opening a device takes longer than a figure";
}

/// A dense cloud is touched by one point for many, and all of them are drawn where they move.
TEST_F(CloudFigureTest, ADenseObjectIsDentedWhereItIsTouched)
{
    constexpr int           kSide = 300;
    std::vector<glm::dvec3> points;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j)
            points.emplace_back(0.06 * (i + 0.5) / kSide - 0.03, 0.06 * (j + 0.5) / kSide - 0.03, 0);
    const PointCloud cloud(points, std::vector<double>(points.size(), 1e6), StiffnessKind::modulus);
    const Patch      patch = deform(SoftObject(cloud), {{5e-3, 4e-3, 0}, {0, 0, 1}},
                                    PatchSettings{.window = 30e-3, .cells = 32, .footprintRadius = 4e-3});
    ASSERT_TRUE(patch.coarse);
    const double     force = 1e-4 / patch.compliance; // [N]
    const glm::dvec3 along = force * patch.forceDirection();

    CloudFigure figure = fromAbove();
    figure.evenLight   = 0;
    figure.up          = {0, 0, 1};
    figure.direction   = {-0.5, 0.6, -1};
    figure.marks       = {patch.contact.point + patch.response(16, 16) * along};
    FigureRenderer renderer;
    EXPECT_EQ(surfaceSvg(cloud, std::vector<PressedPatch>{{&patch, force, ""}},
                         {.title = "", .direction = figure.direction}, renderer),
              figureSvg(points, displaced(cloud, patch, force), deflections(cloud, patch, force), figure));
}

} // namespace
} // namespace palp
