#include "engine/tools/plot/cloud_view.h"

#include <cmath>
#include <ctime>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/tools/plot/cloud_shading.h"
#include "engine/tools/plot/cloud_surface.h"
#include "tests/tools/plot/svg_reader.h"

namespace palp {
namespace {

using test::embeddedImage;
using test::hasText;

constexpr double kRadius = 0.05; // of the sphere [m]

/// Points spread at random on a sphere, pushed in by a Gaussian dent at +z.
std::vector<glm::dvec3> sphere(int count, double dent = 0, double dentWidth = 5e-3)
{
    std::mt19937                           random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<glm::dvec3>                points;
    for (int n = 0; n < count; ++n) {
        const double     z = unit(random), angle = std::numbers::pi * unit(random), r = std::sqrt(1 - z * z);
        const glm::dvec3 p    = kRadius * glm::dvec3(r * std::cos(angle), r * std::sin(angle), z);
        const double     away = glm::distance(p, glm::dvec3(0, 0, kRadius)) / dentWidth;
        points.push_back(p - glm::dvec3(0, 0, dent * std::exp(-0.5 * away * away)));
    }
    return points;
}

/// Looks down the z axis at a square of 120 mm.
CloudCamera fromAbove(int side)
{
    CloudCamera camera;
    camera.width = camera.height = side;
    camera.pixelsPerMetre        = side / 0.12;
    return camera;
}

/// A square sheet of points at height z.
void addSheet(std::vector<glm::dvec3>& points, double halfSide, double z)
{
    constexpr int kSide = 40;
    for (int i = 0; i <= kSide; ++i)
        for (int j = 0; j <= kSide; ++j)
            points.push_back({halfSide * (2.0 * i / kSide - 1), halfSide * (2.0 * j / kSide - 1), z});
}

TEST(CloudSurface, RandomPointsOnASphereCloseWithoutHoles)
{
    const int          side    = 300;
    const CloudSurface surface = cloudSurface(sphere(20000), {}, fromAbove(side));

    const double radius = kRadius * side / 0.12;
    int          holes = 0, spill = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double r = std::hypot(x + 0.5 - side / 2.0, y + 0.5 - side / 2.0);
            if (r < radius - 4) holes += surface.at(x, y).coverage < 1;
            if (r > radius + 2) spill += surface.at(x, y).coverage > 0;
        }
    EXPECT_EQ(holes, 0);
    EXPECT_EQ(spill, 0) << "splats reach 7 px, but the surface ends with the points";
}

TEST(CloudSurface, DepthAndNormalAreThoseOfTheSphere)
{
    const int          side    = 300;
    const CloudSurface surface = cloudSurface(sphere(40000), {}, fromAbove(side));

    const double radius     = kRadius * side / 0.12;
    double       worstDepth = 0, squares = 0;
    int          count = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::dvec2 p(x + 0.5 - side / 2.0, side / 2.0 - y - 0.5);
            const double     r = glm::length(p);
            if (r > 0.7 * radius) continue;
            const double     z = std::sqrt(radius * radius - r * r);
            const glm::dvec3 normal(p.x / radius, p.y / radius, z / radius);
            const auto&      found = surface.at(x, y);
            worstDepth             = std::max(worstDepth, std::abs(double(found.depth) + z));
            squares += std::pow(std::acos(std::min(1.0, glm::dot(normal, glm::dvec3(found.normal)))), 2);
            ++count;
        }
    EXPECT_LT(worstDepth, 0.5)
        << "a plane over a splat's reach of 3 px sags by 3^2 / (2 125 px) = 0.04 px, plus sampling";
    EXPECT_LT(std::sqrt(squares / count), 0.02) << "1 degree: the scatter of a fit to about 10 points";
}

TEST(CloudSurface, NearerSheetHidesTheFartherOne)
{
    std::vector<glm::dvec3> points;
    std::vector<double>     values;
    addSheet(points, 0.05, 0);
    values.resize(points.size(), 0.0);
    addSheet(points, 0.02, 0.02);
    values.resize(points.size(), 1.0);

    CloudCamera        camera = fromAbove(300);
    const CloudSurface above  = cloudSurface(points, values, camera);
    camera.toEye              = {0, 0, -1};
    camera.right              = {-1, 0, 0};
    const CloudSurface below  = cloudSurface(points, values, camera);

    EXPECT_FLOAT_EQ(above.at(150, 150).value, 1);
    EXPECT_FLOAT_EQ(above.at(150, 50).value, 0);
    EXPECT_FLOAT_EQ(below.at(150, 150).value, 0);
    EXPECT_FLOAT_EQ(above.at(150, 150 - 58).value, 0) << "8 px past the edge of the nearer sheet";
    EXPECT_EQ(above.at(150, 150 - 54).coverage, 1) << "4 px past it, the sheet behind shows";
    EXPECT_FLOAT_EQ(above.at(150, 150 - 54).value, 0);
}

TEST(CloudSurface, AFewMissingPointsAreClosedAndAWindowStaysOpen)
{
    // A sheet of points 1 mm apart, 2.5 px, without some in the middle: 4 by 4, then 14 by 14.
    const auto without = [](double halfSide) {
        std::vector<glm::dvec3> points;
        for (int i = -40; i <= 40; ++i)
            for (int j = -40; j <= 40; ++j) {
                const glm::dvec3 p(1e-3 * (i + 0.5), 1e-3 * (j + 0.5), 0);
                if (std::max(std::abs(p.x), std::abs(p.y)) > halfSide) points.push_back(p);
            }
        return cloudSurface(points, {}, fromAbove(300)).at(150, 150).coverage;
    };

    EXPECT_EQ(without(2.1e-3), 1);
    EXPECT_EQ(without(7.1e-3), 0);
}

TEST(CloudSurface, ACrowdedPixelDoesNotStallThePicture)
{
    // A sparse sheet makes wide splats; a million points in one place would each paint as wide: 5 10^9 pixels.
    std::vector<glm::dvec3> points(1000000, glm::dvec3(0.001, 0.001, 0));
    for (int i = -5; i <= 5; ++i)
        for (int j = -5; j <= 5; ++j) points.push_back({0.01 * i, 0.01 * j, 0});

    const std::clock_t start   = std::clock();
    const CloudSurface surface = cloudSurface(points, {}, fromAbove(400));
    const double       seconds = double(std::clock() - start) / CLOCKS_PER_SEC;

    EXPECT_EQ(surface.at(200, 200).coverage, 1);
    EXPECT_EQ(surface.at(100, 300).coverage, 1) << "the crowd leaves the rest alone";
    EXPECT_LT(seconds, 5) << "mostly projecting a million points, under 1 s, but without the bound 10 s and more";
}

TEST(CloudShading, DentOfOnePercentIsPlainlyVisible)
{
    // 1 mm on a sphere of 100 mm, in plain light: no colours.
    const int  side   = 500;
    const auto round  = cloudShading(cloudSurface(sphere(40000), {}, fromAbove(side)));
    const auto dented = cloudShading(cloudSurface(sphere(40000, 1e-3), {}, fromAbove(side)));
    const auto at     = [&](const std::vector<float>& b, int x, int y) { return double(b[std::size_t(y * side + x)]); };

    EXPECT_LT(at(dented, 250, 250), 0.88 * at(round, 250, 250)) << "the bottom of the dent is at least 12 % darker";
    EXPECT_NEAR(at(dented, 250, 250 - 120), at(round, 250, 250 - 120), 0.01) << "29 mm away nothing changes";
}

TEST(CloudView, LegendHasUnitsAndMarkersHaveLabels)
{
    const auto          points = sphere(3000);
    std::vector<double> values(points.size());
    for (std::size_t n = 0; n < values.size(); ++n) values[n] = 1e-3 * points[n].z / kRadius;
    CloudViewSettings settings;
    settings.width = 300, settings.height = 240;
    settings.title   = "cloud <1> & 2";
    settings.markers = {{{0, 0, 0.06}, "proxy", Symbol::circle, {}},
                        {{0, 0, 0.055}, "HIP", Symbol::square, {0, 0, 0.01}}};

    const std::string svg = cloudViewSvg(points, values, settings);

    for (const char* text : {"proxy", "HIP", "cloud <1> & 2", "displacement [\u00b5m]", "x", "y", "z", "50 mm"})
        EXPECT_TRUE(hasText(svg, text)) << text;
    EXPECT_EQ(cloudViewSvg(points, values, settings), svg);
    EXPECT_EQ(embeddedImage(svg).width, 300);
}

TEST(CloudView, WindowShowsItsCentreInTheMiddle)
{
    std::vector<glm::dvec3> points;
    addSheet(points, 0.05, 0);
    std::vector<double> values(points.size());
    for (std::size_t n = 0; n < values.size(); ++n) values[n] = points[n].x;
    CloudViewSettings settings;
    settings.width = settings.height = 200;
    settings.direction               = {0, 0, -1};
    settings.range                   = ValueRange{-0.05, 0.05};

    settings.window   = CloudWindow{{0.03, 0, 0}, 0.01};
    const Image right = embeddedImage(cloudViewSvg(points, values, settings));
    settings.window   = CloudWindow{{-0.03, 0, 0}, 0.01};
    const Image left  = embeddedImage(cloudViewSvg(points, values, settings));

    EXPECT_GT(right.at(100, 100).green, left.at(100, 100).green + 50);
    EXPECT_GT(right.at(190, 100).green, right.at(10, 100).green + 10) << "x grows to the right";
}

TEST(CloudView, WholeCloudFitsThePicture)
{
    CloudViewSettings settings;
    settings.width = 300, settings.height = 200;

    const Image image = embeddedImage(cloudViewSvg(sphere(20000), {}, settings));

    int highest = image.height, border = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.at(x, y) != Rgb8{255, 255, 255}) {
                highest = std::min(highest, y);
                border += x == 0 || y == 0 || x + 1 == image.width || y + 1 == image.height;
            }
    EXPECT_EQ(border, 0);
    EXPECT_LT(highest, 40) << "and it fills most of it";
}

TEST(CloudView, DegenerateCloudsGiveThePictureOfTheContract)
{
    CloudViewSettings settings;
    settings.width = settings.height = 200;
    const std::vector<glm::dvec3> none, nowhere(3, glm::dvec3(NAN, 0, 0)), same(5, glm::dvec3(1, 2, 3));

    EXPECT_TRUE(hasText(cloudViewSvg(none, {}, settings), "no points to draw"));
    const std::string lost = cloudViewSvg(nowhere, {}, settings);
    EXPECT_TRUE(hasText(lost, "no points to draw"));
    EXPECT_TRUE(hasText(lost, "3 points without a finite position are left out. "));
    const Image spot = embeddedImage(cloudViewSvg(same, {}, settings));
    EXPECT_NE(spot.at(100, 100), (Rgb8{255, 255, 255}));
    EXPECT_EQ(spot.at(2, 2), (Rgb8{255, 255, 255}));
}

TEST(CloudView, PointsWithoutValueAreGreyAndCounted)
{
    std::vector<glm::dvec3> points;
    addSheet(points, 0.05, 0);
    std::vector<double> values(points.size());
    for (std::size_t n = 0; n < values.size(); ++n) values[n] = points[n].x < 0 ? (n % 2 == 0 ? NAN : INFINITY) : 1;
    CloudViewSettings settings;
    settings.width = settings.height = 200;
    settings.direction               = {0, 0, -1};

    const std::string svg   = cloudViewSvg(points, values, settings);
    const Image       image = embeddedImage(svg);

    EXPECT_TRUE(hasText(svg, "820 points without a value that can be drawn are grey."));
    const Rgb8 grey = image.at(60, 100), coloured = image.at(140, 100);
    EXPECT_EQ(grey.red, grey.blue);
    EXPECT_NE(coloured.red, coloured.blue);
    EXPECT_FALSE(test::readSvg(cloudViewSvg(points, std::vector<double>(points.size(), NAN), settings)).empty());
}

TEST(CloudView, RefusesSettingsThatMakeNoPicture)
{
    const std::vector<glm::dvec3> points(3);
    const std::vector<double>     values(2);
    CloudViewSettings             settings;
    EXPECT_THROW((void)cloudViewSvg(points, values, settings), ContractViolation);
    settings.direction = settings.up;
    EXPECT_THROW((void)cloudViewSvg(points, {}, settings), ContractViolation);
    settings       = {};
    settings.width = 1 << 20;
    EXPECT_THROW((void)cloudViewSvg(points, {}, settings), ContractViolation);
    settings        = {};
    settings.window = CloudWindow{{0, 0, 0}, 0};
    EXPECT_THROW((void)cloudViewSvg(points, {}, settings), ContractViolation);
}

TEST(CloudView, TheScaleBarHasALengthWhateverTheSize)
{
    for (const double halfWidth : {1e-3, 9e-3, 10.5e-3, 12e-3, 13.9e-3, 20e-3, 60e-3}) { // 12e-3: 4.27 mm at most
        CloudViewSettings settings;
        settings.window = CloudWindow{{0, 0, 0}, halfWidth};
        const auto svg  = cloudViewSvg(sphere(100), {}, settings);
        for (const char* unit : {"mm", "\u00b5m", "m"})
            EXPECT_FALSE(hasText(svg, std::string("0 ") + unit)) << halfWidth;
    }
}

} // namespace
} // namespace palp
