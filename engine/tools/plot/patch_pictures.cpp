#include "engine/tools/plot/patch_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "engine/core/quantity.h"
#include "engine/tools/plot/cloud_view.h"
#include "engine/tools/plot/heat_map.h"
#include "engine/tools/plot/line_plot.h"

namespace palp {
namespace {

/// What both charts show alike.
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

/// Looks at the contact from outside, 55 degrees off its normal, so that a dent shows its depth.
glm::dvec3 obliquely(const Frame& frame)
{
    return -glm::normalize(0.57 * frame.normal + 0.30 * frame.east - 0.76 * frame.north);
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

std::string surfaceSvg(const PointCloud& cloud, std::span<const PressedPatch> patches, const SurfaceView& view)
{
    std::vector<glm::dvec3> positions(cloud.positions().begin(), cloud.positions().end());
    std::vector<double>     depth(cloud.size(), 0.0);
    CloudViewSettings       settings;
    for (const PressedPatch& p : patches) {
        for (std::size_t n = 0; n < p.patch->points.size(); ++n) {
            const double w = p.force * p.patch->pointResponse[n];
            depth[p.patch->points[n]] += w;
            positions[p.patch->points[n]] += view.exaggeration * w * p.patch->forceDirection();
        }
        const int        middle = p.patch->window.grid.cellsX / 2;
        const glm::dvec3 bottom = p.patch->contact.point + view.exaggeration * p.force *
                                                               p.patch->response(middle, middle) *
                                                               p.patch->forceDirection();
        settings.markers.push_back({bottom, p.label, Symbol::circle, {}});
    }
    const Chart& chart = patches.front().patch->chart;
    settings.title     = view.title;
    settings.quantity  = "deflection";
    const bool given   = glm::length(view.direction) > 0;
    settings.up        = given ? glm::dvec3(0, 0, 1) : chart.frame.normal;
    settings.direction = given ? view.direction : obliquely(chart.frame);
    if (view.closeUp)
        settings.window =
            CloudWindow{patches.front().patch->contact.point, 0.75 * patches.front().patch->window.grid.sizeX()};
    return cloudViewSvg(positions, depth, settings);
}

double roundExaggeration(double deepest, double size)
{
    constexpr double kVisible = 1.0 / 30; // of the object: plain to see, and still clearly a dent
    if (!(deepest > 0)) return 1;
    for (double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
        if (factor * deepest > 0.6 * kVisible * size) return factor;
    return 200;
}

} // namespace palp
