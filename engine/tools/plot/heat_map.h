#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/core/grid.h"
#include "engine/tools/plot/axis.h"

namespace palp {

/// How the field looks between its nodes.
enum class NodeStyle {
    cells,  ///< a flat cell around every node: shows the grid as it is
    smooth, ///< values interpolated linearly between nodes
};

struct HeatMapSettings {
    std::string               title;
    std::string               quantity = "deflection"; ///< label of the colour bar
    std::string               unit     = "m";          ///< SI unit of the values; the prefix is chosen
    Scale                     scale    = Scale::linear;
    std::optional<ValueRange> range; ///< ends of the colours [unit]; absent: the smallest and largest drawable value
    NodeStyle                 nodeStyle = NodeStyle::cells;
    PlateGrid                 grid;                ///< where the nodes lie
    ChartPoint                corner;              ///< position of node (0, 0)
    bool                      markExtremes = true; ///< a triangle at the largest value, a diamond at the smallest
    std::optional<ChartPoint> contact;             ///< a cross
    double                    footprintRadius = 0; ///< of a circle around the contact [m]; 0 is none
    std::vector<ChartPoint>   points;              ///< dots, such as the projected points of the cloud
    std::string               undrawn; ///< what nodes without a value are, for the legend; empty: not finite
};

/// Draws a field as a self-contained SVG picture: colours, axes of equal scale, colour bar, overlays and legend. Chart
/// x is called east and chart z north, as in a patch's frame: x, y and z are axes of the world.
///
/// Nodes whose value is NaN or infinite, or not positive on a logarithmic scale, are hatched grey, and the legend says
/// how many they are, or what. A constant field (to 1e-6 of its value) is drawn in the middle colour; the legend gives
/// the value and no extremes. Values beyond an explicit range take the end colour, and the colour bar ends in an arrow
/// head.
/// \pre the field lies on settings.grid, which has positive spacings; an explicit range is drawable and not reversed
[[nodiscard]] std::string heatMapSvg(const NodeField& field, const HeatMapSettings& settings);

} // namespace palp
