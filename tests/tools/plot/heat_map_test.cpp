#include "engine/tools/plot/heat_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/tools/plot/colour_map.h"
#include "tests/tools/plot/svg_reader.h"

namespace palp {
namespace {

using test::embeddedImage;
using test::hasText;

HeatMapSettings settingsOn(const PlateGrid& grid)
{
    HeatMapSettings settings;
    settings.grid = grid;
    return settings;
}

TEST(HeatMap, NodesLieWhereTheAxesSay)
{
    const PlateGrid grid{4, 2, 1e-3, 1e-3};
    NodeField       field(grid, 0);
    field(4, 0) = 1; // right, bottom
    field(0, 2) = 0.5;

    const Image image = embeddedImage(heatMapSvg(field, settingsOn(grid)));

    EXPECT_EQ(image.at(image.width - 1, image.height - 1), colourAt(1));
    EXPECT_EQ(image.at(0, 0), colourAt(0.5));
    EXPECT_EQ(image.at(0, image.height - 1), colourAt(0));
    EXPECT_EQ(image.at(image.width - 1, 0), colourAt(0));
    EXPECT_EQ(image.width * 3, image.height * 5) << "5 by 3 square cells";
}

TEST(HeatMap, AxesHaveEqualScale)
{
    const PlateGrid grid{30, 10, 1e-3, 2e-3};

    const auto image = test::elementsOf(heatMapSvg(NodeField(grid, 1), settingsOn(grid)), "image").at(0);

    // 31 mm by 22 mm; positions are written to 0.01 px.
    EXPECT_NEAR(std::stod(image.attributes.at("width")) / std::stod(image.attributes.at("height")), 31.0 / 22, 1e-3);
}

TEST(HeatMap, LegendGivesExtremesWithUnitAndPlace)
{
    const PlateGrid grid{20, 20, 1e-3, 1e-3};
    NodeField       field(grid, 0);
    field(10, 5)             = 4.2e-4;
    field(2, 3)              = -1e-5;
    HeatMapSettings settings = settingsOn(grid);
    settings.corner          = {-0.010, -0.010};
    settings.title           = "a < b & \"c\" > d";

    const std::string svg = heatMapSvg(field, settings);

    EXPECT_TRUE(hasText(svg, "max 420 \u00b5m at east 0 mm, north \u22125.00 mm"));
    EXPECT_TRUE(hasText(svg, "min \u221210.0 \u00b5m at east \u22128.00 mm, north \u22127.00 mm"));
    EXPECT_TRUE(hasText(svg, "deflection [\u00b5m]"));
    EXPECT_TRUE(hasText(svg, "east [mm]"));
    EXPECT_TRUE(hasText(svg, settings.title));
    EXPECT_EQ(heatMapSvg(field, settings), svg);
}

TEST(HeatMap, TheTriangleIsWhereItsLegendSaysEvenAtTheContact)
{
    const PlateGrid grid{20, 20, 1e-3, 1e-3};
    NodeField       field(grid, 0);
    field(10, 20)            = 1; // at the upper edge
    HeatMapSettings settings = settingsOn(grid);
    settings.nodeStyle       = NodeStyle::smooth;
    settings.contact         = ChartPoint{10e-3, 20e-3};

    const std::string svg   = heatMapSvg(field, settings);
    const auto        image = test::elementsOf(svg, "image").at(0).attributes;
    const double      x = std::stod(image.at("x")) + std::stod(image.at("width")) / 2, y = std::stod(image.at("y"));
    const auto        paths = test::elementsOf(svg, "path");
    const bool        found = std::ranges::any_of(paths, [&](const test::SvgElement& path) {
        std::istringstream corners(path.attributes.at("d"));
        double             sumX = 0, sumY = 0, cornerX = 0, cornerY = 0;
        char               letter = 0;
        int                count  = 0;
        for (; corners >> letter >> cornerX >> cornerY; ++count) sumX += cornerX, sumY += cornerY;
        return letter == 'Z' && count == 3 &&
               std::hypot(sumX / 3 - x, sumY / 3 - y) < 2; // [px] its tip is longer than its corners
    });

    EXPECT_TRUE(found) << "no triangle around (" << x << ", " << y << ")";
}

TEST(HeatMap, ValuesThatCannotBeDrawnAreHatchedAndCounted)
{
    const PlateGrid grid{3, 3, 1e-3, 1e-3};
    NodeField       field(grid, 2);
    field(0, 0) = NAN;
    field(3, 3) = 8;
    field(1, 1) = -1;

    HeatMapSettings settings = settingsOn(grid);
    const auto      linear   = heatMapSvg(field, settings);
    settings.scale           = Scale::logarithmic;
    const auto logarithmic   = heatMapSvg(field, settings);

    EXPECT_TRUE(hasText(linear, "1 not finite"));
    EXPECT_TRUE(hasText(logarithmic, "2 not finite or not positive"));
    settings.undrawn = "beyond the border";
    EXPECT_TRUE(hasText(heatMapSvg(field, settings), "beyond the border"));
    EXPECT_FALSE(hasText(heatMapSvg(field, settings), "2 not finite or not positive"));
    const Image image = embeddedImage(logarithmic);
    const int   cell  = image.width / 4;
    std::size_t grey  = 0;
    for (int y = 3 * cell; y < 4 * cell; ++y)
        for (int x = 0; x < cell; ++x) grey += image.at(x, y) == kUndefinedColour;
    EXPECT_GT(grey, std::size_t(cell) * std::size_t(cell) / 2)
        << "the cell of node (0, 0) is mostly the grey of the hatch";
    EXPECT_EQ(image.at(3 * cell + 5, 5), colourAt(1));
}

TEST(HeatMap, LogarithmicColoursFollowTheExponent)
{
    const PlateGrid grid{2, 1, 1e-3, 1e-3};
    NodeField       field(grid, 1e-4);
    for (int j = 0; j < 2; ++j) field(1, j) = 1e-3, field(2, j) = 1e-2;
    HeatMapSettings settings = settingsOn(grid);
    settings.scale           = Scale::logarithmic;
    settings.unit            = "N m";
    settings.quantity        = "rigidity";

    const std::string svg   = heatMapSvg(field, settings);
    const Image       image = embeddedImage(svg);

    EXPECT_EQ(image.at(image.width / 2, 0), colourAt(0.5));
    EXPECT_TRUE(hasText(svg, "rigidity [mN m]"));
    for (const char* label : {"0.1", "1", "10"}) EXPECT_TRUE(hasText(svg, label)) << label;
}

TEST(HeatMap, ConstantAndEmptyFieldsAreDrawn)
{
    const PlateGrid grid{5, 5, 1e-3, 1e-3};

    EXPECT_TRUE(hasText(heatMapSvg(NodeField(grid, 0.0042), settingsOn(grid)), "constant 4.20 mm"));
    EXPECT_TRUE(hasText(heatMapSvg(NodeField(grid, 0), settingsOn(grid)), "constant 0 m"));
    EXPECT_TRUE(hasText(heatMapSvg(NodeField(grid, NAN), settingsOn(grid)), "36 not finite"));
}

TEST(HeatMap, RoundingErrorsHaveNoExtremes)
{
    const PlateGrid grid{5, 5, 1e-3, 1e-3};
    NodeField       field(grid, 0.0042);
    field(2, 3) *= 1 + 5e-7;

    const std::string svg = heatMapSvg(field, settingsOn(grid));

    EXPECT_TRUE(hasText(svg, "constant 4.20 mm"));
    EXPECT_EQ(svg.find("max "), std::string::npos);
    field(2, 3) *= 1 + 5e-6;
    EXPECT_NE(heatMapSvg(field, settingsOn(grid)).find("max "), std::string::npos);
}

TEST(HeatMap, ColourBarPointsToValuesBeyondAnExplicitRange)
{
    const PlateGrid grid{2, 2, 1e-3, 1e-3};
    NodeField       field(grid, 0);
    field(1, 1)              = 5;
    HeatMapSettings settings = settingsOn(grid);
    settings.markExtremes    = false;

    settings.range    = ValueRange{0, 5};
    const auto fits   = test::elementsOf(heatMapSvg(field, settings), "path").size();
    settings.range    = ValueRange{0, 4};
    const auto beyond = test::elementsOf(heatMapSvg(field, settings), "path").size();
    settings.range    = ValueRange{1, 4};
    const auto both   = test::elementsOf(heatMapSvg(field, settings), "path").size();

    EXPECT_EQ(beyond, fits + 1);
    EXPECT_EQ(both, fits + 2);
}

TEST(HeatMap, SmoothStyleInterpolatesValuesNotColours)
{
    const PlateGrid grid{1, 1, 1e-3, 1e-3};
    NodeField       field(grid, 0);
    field(1, 0) = field(1, 1) = 1;
    HeatMapSettings settings  = settingsOn(grid);
    settings.nodeStyle        = NodeStyle::smooth;

    const Image image  = embeddedImage(heatMapSvg(field, settings));
    const Rgb8  middle = image.at(image.width / 2, image.height / 2), expected = colourAt(0.5);

    EXPECT_LE(std::abs(middle.red - expected.red) + std::abs(middle.green - expected.green), 4)
        << "half a pixel off the middle";
}

TEST(HeatMap, OverlaysOutsideTheChartAreLeftOut)
{
    const PlateGrid grid{4, 4, 1e-3, 1e-3};
    HeatMapSettings settings = settingsOn(grid);
    settings.points          = {{1e-3, 1e-3}, {1, 1}, {NAN, 0}, {1e300, 0}};
    settings.contact         = ChartPoint{1e9, 0};
    settings.footprintRadius = 1e-3;

    const std::string svg = heatMapSvg(NodeField(grid, 1), settings);

    EXPECT_TRUE(hasText(svg, "contact: outside"));
    EXPECT_TRUE(hasText(svg, "points in the patch window: 1"));
    settings.contact = ChartPoint{2e-3, 2e-3};
    EXPECT_TRUE(hasText(heatMapSvg(NodeField(grid, 1), settings), "footprint, radius 1.00 mm"));
    EXPECT_THROW((void)heatMapSvg(NodeField(PlateGrid{3, 4, 1, 1}), settings), ContractViolation);
}

} // namespace
} // namespace palp
