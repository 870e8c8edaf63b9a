#include "engine/tools/paper/perception_figures.h"

#include <algorithm>
#include <array>
#include <span>

#include <glm/geometric.hpp>

#include "engine/chart/chart.h"
#include "engine/tools/plot/line_plot.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp::report {
namespace {

PlotSeries seriesOf(std::span<const FeltTick> ticks, const std::string& name, SeriesStyle style)
{
    PlotSeries series{name, {}, {}, style};
    for (const FeltTick& tick : ticks) {
        series.x.push_back(tick.along);
        series.y.push_back(tick.stiffness);
    }
    return series;
}

/// Returns the first half of a stroke: on the way back its dashes would fill the gaps between those of the way out.
std::span<const FeltTick> wayOut(std::span<const FeltTick> stroke)
{
    return {stroke.begin(), std::ranges::max_element(stroke, {}, &FeltTick::along)};
}

} // namespace

std::string pathSvg(const ScenePerception& perception, ForceLaw law, const std::string& title)
{
    PlotSeries rest{"finger at rest", {}, {}, SeriesStyle::markers};
    for (const FeltPlace& place : perception.places) {
        rest.x.push_back(place.along);
        rest.y.push_back(place.felt(law));
    }
    const std::array<PlotSeries, 3> series{
        seriesOf(perception.stroke, "sliding to and fro", SeriesStyle::line), // the first: a full line
        rest, seriesOf(wayOut(perception.floor), "sliding, one stiffness everywhere", SeriesStyle::reference)};
    LinePlotSettings settings;
    settings.title = title;
    settings.x     = {"along the path", "m", Scale::linear, {}};
    settings.y     = {"felt stiffness", "N/m", Scale::linear, {}};
    return linePlotSvg(series, settings);
}

std::string mapSvg(const PointCloud& cloud, const FeltMap& map, double weber, const glm::dvec3& outward,
                   const std::string& title, FigureRenderer& renderer)
{
    const Frame frame = Frame::about(outward);
    CloudFigure settings;
    settings.title     = title;
    settings.quantity  = "right answers against the typical place";
    settings.unit      = "";
    settings.range     = ValueRange{0.5, 1};
    settings.direction = -glm::normalize(0.85 * frame.normal + 0.10 * frame.east - 0.52 * frame.north);
    settings.up        = frame.north;
    return cloudFigureSvg(cloud.positions(), cloud.positions(), detectability(map, weber), settings, renderer);
}

} // namespace palp::report
