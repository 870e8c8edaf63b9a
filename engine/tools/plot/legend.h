#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/tools/plot/svg.h"

namespace palp {

/// Shapes that differ without colour.
enum class Symbol { circle, square, triangleUp, triangleDown, diamond, cross, plus };

/// Draws a symbol about `radius` px in size, with a white edge so that it stands out on any ground.
void drawSymbol(SvgDrawing& svg, Symbol symbol, glm::dvec2 at, double radius, std::string_view colour);

struct LegendEntry {
    std::string                                  text;
    std::function<void(SvgDrawing&, glm::dvec2)> draw; ///< draws the mark, kLegendMarkWidth px wide, around a centre
};

inline constexpr double kLegendMarkWidth = 26; ///< [px]

/// Writes entries in rows from left to right.
/// \return the height used [px]
double drawLegend(SvgDrawing& svg, const std::vector<LegendEntry>& entries, glm::dvec2 corner, double width);

} // namespace palp
