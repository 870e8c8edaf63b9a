#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/tools/plot/axis.h"

namespace palp {

enum class SeriesStyle {
    line,           ///< of many points: a line with its own colour and dashes
    lineAndMarkers, ///< of few points: a line, and markers of its own shape at the points (some, if many)
    markers,        ///< a marker at every point
    reference,      ///< reference for the others: a thin dark line beneath them
};

/// A named sequence of points. A point that cannot be drawn (NaN, infinity, not positive on a logarithmic axis) breaks
/// the line, and the legend says how many there are.
struct PlotSeries {
    std::string         name;
    std::vector<double> x; ///< in the unit of the axis, as many as y
    std::vector<double> y;
    SeriesStyle         style = SeriesStyle::lineAndMarkers;
};

struct PlotAxis {
    std::string               quantity;
    std::string               unit; ///< SI unit of the values; the prefix is chosen
    Scale                     scale = Scale::linear;
    std::optional<ValueRange> range; ///< absent: all drawable values with a margin
};

struct LinePlotSettings {
    std::string title;
    PlotAxis    x;
    PlotAxis    y;
    double      width  = 560; ///< of the plotted area [px]
    double      height = 340; ///< [px]
};

/// Draws series as a self-contained SVG picture that can be read without colour; the legend stands above the plotted
/// area and never covers it. Long series are thinned to what the pixels can show: the extremes of every column stay.
[[nodiscard]] std::string linePlotSvg(std::span<const PlotSeries> series, const LinePlotSettings& settings);

} // namespace palp
