#pragma once
#include <string_view>

#include "engine/tools/plot/axis.h"
#include "engine/tools/plot/svg.h"

namespace palp {

/// The rectangle of a plot on the page, and what its two axes mean.
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

/// Pale lines at the ticks, to be drawn under the data.
void drawGridLines(SvgDrawing& svg, const PlotFrame& frame);

/// Border, ticks, labels and titles, to be drawn over the data.
void drawFrame(SvgDrawing& svg, const PlotFrame& frame, std::string_view quantityX, std::string_view quantityY);

} // namespace palp
