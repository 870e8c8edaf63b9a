#include "engine/tools/plot/patch_pictures.h"

#include "engine/core/quantity.h"
#include "engine/tools/plot/heat_map.h"
#include "engine/tools/plot/line_plot.h"

namespace palp {
namespace {

/// The settings that both charts share.
HeatMapSettings chartSettings(const Patch& patch, const PatchSettings& settings, const std::string& title)
{
    HeatMapSettings chart;
    chart.title           = title;
    chart.grid            = patch.window.grid;
    chart.corner          = patch.window.corner;
    chart.contact         = ChartPoint{0, 0};
    chart.footprintRadius = settings.footprintRadius;
    return chart;
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
        const int i = along == Along::east ? n : grid.cellsX / 2, j = along == Along::east ? grid.cellsZ / 2 : n;
        series.x.push_back(along == Along::east ? patch.window.corner.x + i * grid.spacingX
                                                : patch.window.corner.z + j * grid.spacingZ);
        series.y.push_back(force * patch.response(i, j));
    }
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
    HeatMapSettings chart           = chartSettings(patch, settings, title);
    chart.quantity                  = "flexural rigidity";
    chart.unit                      = "N m";
    chart.scale                     = Scale::logarithmic;
    constexpr std::size_t kMostDots = 3000; // more would hide the colours
    for (const ChartPoint& p : patch.positions)
        if (patch.window.holds(p)) chart.points.push_back(p);
    if (chart.points.size() > kMostDots) chart.points.clear();
    return heatMapSvg(patch.plate.rigidity, chart);
}

std::string deflectionChartSvg(const Patch& patch, const PatchSettings& settings, double force,
                               const std::string& title, double deepest)
{
    HeatMapSettings chart = chartSettings(patch, settings, title);
    chart.nodeStyle       = NodeStyle::smooth;
    if (deepest > 0) chart.range = ValueRange{0, deepest};
    return heatMapSvg(scaled(patch.response, force), chart);
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
