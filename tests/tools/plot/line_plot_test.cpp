#include "engine/tools/plot/line_plot.h"

#include <cmath>
#include <cstdio>
#include <set>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/tools/plot/svg_reader.h"

namespace palp {
namespace {

using test::elementsOf;
using test::hasText;

LinePlotSettings forceAxes()
{
    LinePlotSettings settings;
    settings.title = "force & <depth>";
    settings.x     = {"penetration", "m", Scale::linear, {}};
    settings.y     = {"force", "N", Scale::linear, {}};
    return settings;
}

PlotSeries ramp(const std::string& name, int points, double slope)
{
    PlotSeries s{name, {}, {}, SeriesStyle::lineAndMarkers};
    for (int n = 0; n < points; ++n) s.x.push_back(1e-3 * n / points), s.y.push_back(slope * s.x.back());
    return s;
}

TEST(LinePlot, LabelsAxesAndSeries)
{
    const PlotSeries  series[] = {ramp("soft", 10, 200), ramp("stiff \"A\"", 10, 900)};
    const std::string svg      = linePlotSvg(series, forceAxes());

    for (const char* text : {"penetration [\u00b5m]", "force [mN]", "soft", "stiff \"A\"", "force & <depth>", "400"})
        EXPECT_TRUE(hasText(svg, text)) << text;
    EXPECT_EQ(linePlotSvg(series, forceAxes()), svg);
}

TEST(LinePlot, LegendStandsOutsideThePlottedArea)
{
    std::vector<PlotSeries> series;
    for (int n = 0; n < 12; ++n) series.push_back(ramp("a series with quite a long name " + std::to_string(n), 10, n));

    const std::string svg   = linePlotSvg(series, forceAxes());
    const double      frame = std::stod(elementsOf(svg, "svg").at(1).attributes.at("y"));

    int names = 0;
    for (const auto& text : elementsOf(svg, "text"))
        if (text.text.starts_with("a series")) {
            ++names;
            EXPECT_LT(std::stod(text.attributes.at("y")), frame - 3);
        }
    EXPECT_EQ(names, 12);
}

TEST(LinePlot, SeriesDifferWithoutColour)
{
    std::vector<PlotSeries> series;
    for (int n = 0; n < 5; ++n) {
        series.push_back(ramp(std::to_string(n), 5, n + 1));
        series.back().style = SeriesStyle::line;
    }

    std::set<std::string> dashes;
    for (const auto& path : elementsOf(linePlotSvg(series, forceAxes()), "path"))
        dashes.insert(path.attributes.contains("stroke-dasharray") ? path.attributes.at("stroke-dasharray") : "full");

    EXPECT_EQ(dashes.size(), 5U);
}

TEST(LinePlot, ThinningKeepsSpikesBothWays)
{
    PlotSeries s{"", {}, {}, SeriesStyle::line};
    for (int n = 0; n < 200000; ++n) s.x.push_back(n), s.y.push_back(0.001 * (n % 7));
    s.y[123456]               = 1;
    s.y[54321]                = -1;
    LinePlotSettings settings = forceAxes();
    settings.y.range          = ValueRange{-2, 2};

    const std::string svg = linePlotSvg(std::span(&s, 1), settings);

    EXPECT_LT(svg.size(), 60'000U) << "at most four points of 14 characters in each of 560 columns";
    const double      top  = std::stod(elementsOf(svg, "svg").at(1).attributes.at("y"));
    const std::string path = elementsOf(svg, "path").at(0).attributes.at("d");
    for (double share : {0.25, 0.75}) { // of the height, where 1 and -1 lie
        char text[32];
        std::snprintf(text, sizeof text, " %gL", top + share * settings.height);
        EXPECT_NE(path.find(text), std::string::npos) << text;
    }
}

TEST(LinePlot, PointsThatCannotBeDrawnBreakTheLineAndAreCounted)
{
    PlotSeries s{"gap", {1, 2, 3, 4, 5, 6}, {1, 2, NAN, 4, -5, 6}, SeriesStyle::line};

    LinePlotSettings settings = forceAxes();
    const auto       linear   = linePlotSvg(std::span(&s, 1), settings);
    settings.y.scale          = Scale::logarithmic;
    const auto logarithmic    = linePlotSvg(std::span(&s, 1), settings);

    EXPECT_TRUE(hasText(linear, "gap (1 not drawn)"));
    EXPECT_EQ(elementsOf(linear, "path").size(), 2U);
    EXPECT_TRUE(hasText(logarithmic, "gap (2 not drawn)"));
    EXPECT_EQ(elementsOf(logarithmic, "path").size(), 3U);
}

TEST(LinePlot, NothingToShowIsStillAPicture)
{
    EXPECT_FALSE(test::readSvg(linePlotSvg({}, forceAxes())).empty());
    const PlotSeries none{"none", {NAN}, {NAN}, SeriesStyle::markers}, one{"one", {3}, {3}, SeriesStyle::line};
    EXPECT_TRUE(hasText(linePlotSvg(std::span(&none, 1), forceAxes()), "none (1 not drawn)"));
    EXPECT_EQ(elementsOf(linePlotSvg(std::span(&one, 1), forceAxes()), "path").size(), 1U)
        << "a lone point shows as a dot";
}

TEST(LinePlot, RefusesSeriesOfUnequalLength)
{
    const PlotSeries bad{"bad", {1, 2}, {1}, SeriesStyle::line};
    EXPECT_THROW((void)linePlotSvg(std::span(&bad, 1), forceAxes()), ContractViolation);
}

} // namespace
} // namespace palp
