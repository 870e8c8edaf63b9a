#include "engine/tools/plot/patch_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/quantity.h"
#include "engine/tools/plot/heat_map.h"
#include "engine/tools/plot/line_plot.h"

namespace palp {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

std::size_t nodeOf(const PlateGrid& grid, int i, int j)
{
    return std::size_t(i) * std::size_t(grid.nodesZ()) + std::size_t(j);
}

/// Draws a field of the patch's nodes; of an object that the window spans no more than what is around it, and nothing
/// beyond its border.
std::string chartSvg(const Patch& patch, const NodeField& field, const PatchSettings& settings, HeatMapSettings chart)
{
    constexpr int    kMargin = 4; // cells
    const PlateGrid& whole   = patch.window.grid;
    int              lowX = whole.cellsX, highX = 0, lowZ = whole.cellsZ, highZ = 0; // nodes
    for (int i = 0; i <= whole.cellsX; ++i)
        for (int j = 0; j <= whole.cellsZ; ++j) {
            if (!isOnSheet(patch, nodeOf(patch.window.grid, i, j))) continue;
            lowX = std::min(lowX, i), highX = std::max(highX, i);
            lowZ = std::min(lowZ, j), highZ = std::max(highZ, j);
        }
    const auto within = [](int& low, int& high, int last) {
        low = std::max(low - kMargin, 0), high = std::min(high + kMargin, last);
    };
    within(lowX, highX, whole.cellsX);
    within(lowZ, highZ, whole.cellsZ);
    chart.grid    = {highX - lowX, highZ - lowZ, whole.spacingX, whole.spacingZ};
    chart.corner  = {patch.window.corner.x + lowX * whole.spacingX, patch.window.corner.z + lowZ * whole.spacingZ};
    chart.contact = ChartPoint{0, 0};
    chart.footprintRadius = settings.footprintRadius;
    if (!patch.covered.values().empty()) chart.undrawn = "beyond the border";
    NodeField shown(chart.grid);
    for (int i = lowX; i <= highX; ++i)
        for (int j = lowZ; j <= highZ; ++j)
            shown(i - lowX, j - lowZ) = isOnSheet(patch, nodeOf(patch.window.grid, i, j)) ? field(i, j) : kNoValue;
    return heatMapSvg(shown, chart);
}

NodeField scaled(NodeField field, double factor)
{
    for (double& value : field.values()) value *= factor;
    return field;
}

enum class Along { east, north };

PlotSeries profileOf(const Patch& patch, double force, Along along, std::string name)
{
    const PlateGrid& grid = patch.window.grid;
    PlotSeries       series{std::move(name), {}, {}, SeriesStyle::lineAndMarkers};
    const int        nodes = along == Along::east ? grid.nodesX() : grid.nodesZ();
    for (int n = 0; n < nodes; ++n) {
        const int  i = along == Along::east ? n : grid.cellsX / 2, j = along == Along::east ? grid.cellsZ / 2 : n;
        const bool on = isOnSheet(patch, nodeOf(grid, i, j));
        if (!on && (series.y.empty() || std::isnan(series.y.back()))) continue; // one breaks the line
        series.x.push_back(along == Along::east ? patch.window.corner.x + i * grid.spacingX
                                                : patch.window.corner.z + j * grid.spacingZ);
        series.y.push_back(on ? force * patch.response(i, j) : kNoValue);
    }
    if (!series.y.empty() && std::isnan(series.y.back())) series.x.pop_back(), series.y.pop_back();
    return series;
}

LinePlotSettings profileAxes(const std::string& title)
{
    LinePlotSettings plot;
    plot.title = title;
    plot.x     = {"distance from the contact", "m", Scale::linear, {}};
    plot.y     = {"deflection", "m", Scale::linear, {}};
    return plot;
}

} // namespace

std::string rigidityChartSvg(const Patch& patch, const PatchSettings& settings, const std::string& title)
{
    HeatMapSettings chart;
    chart.title                     = title;
    chart.quantity                  = "flexural rigidity";
    chart.unit                      = "N m";
    chart.scale                     = Scale::logarithmic;
    constexpr std::size_t kMostDots = 3000; // more would hide the colours
    for (const ChartPoint& p : patch.positions)
        if (patch.window.holds(p)) chart.points.push_back(p);
    if (chart.points.size() > kMostDots) chart.points.clear();
    return chartSvg(patch, sheetRigidity(patch), settings, std::move(chart));
}

std::string deflectionChartSvg(const Patch& patch, const PatchSettings& settings, double force,
                               const std::string& title, double deepest)
{
    HeatMapSettings chart;
    chart.title     = title;
    chart.nodeStyle = NodeStyle::smooth;
    if (deepest > 0) chart.range = ValueRange{0, deepest};
    return chartSvg(patch, scaled(patch.response, force), settings, std::move(chart));
}

std::string profileSvg(const Patch& patch, double force, const std::string& title)
{
    const PlotSeries series[] = {profileOf(patch, force, Along::east, "eastwards"),
                                 profileOf(patch, force, Along::north, "northwards")};
    return linePlotSvg(series, profileAxes(title));
}

std::string profilesSvg(std::span<const PressedPatch> patches, const std::string& title)
{
    std::vector<PlotSeries> series;
    for (const PressedPatch& p : patches) series.push_back(profileOf(*p.patch, p.force, Along::east, p.label));
    return linePlotSvg(series, profileAxes(title));
}

} // namespace palp
