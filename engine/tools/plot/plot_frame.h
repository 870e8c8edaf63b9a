#pragma once
#include <string_view>

#include "engine/tools/plot/axis.h"
#include "engine/tools/plot/svg.h"

namespace palp {

/// The rectangle of a plot on the page, and its two axes.
struct PlotFrame {
    glm::dvec2 corner; ///< upper left [px]
    glm::dvec2 size;   ///< [px]
    Axis       x;      ///< to the right
    Axis       y;      ///< up

    [[nodiscard]] double     pixelX(double value) const { return corner.x + size.x * x.position(value); }
    [[nodiscard]] double     pixelY(double value) const { return corner.y + size.y * (1 - y.position(value)); }
    [[nodiscard]] glm::dvec2 pixel(double valueX, double valueY) const { return {pixelX(valueX), pixelY(valueY)}; }
};

inline constexpr double kFrameLeft  = 74; ///< room for the labels on the left of a frame [px]
inline constexpr double kFrameBelow = 50; ///< room for the labels below a frame [px]

/// Draws pale lines at the ticks; must be called before the data are drawn.
void drawGridLines(SvgDrawing& svg, const PlotFrame& frame);

/// Draws border, ticks, labels and titles; must be called after the data are drawn.
void drawFrame(SvgDrawing& svg, const PlotFrame& frame, std::string_view quantityX, std::string_view quantityY);

} // namespace palp
