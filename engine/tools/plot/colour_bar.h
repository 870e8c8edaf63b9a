#pragma once
#include <functional>
#include <optional>
#include <string_view>

#include "engine/tools/plot/axis.h"
#include "engine/tools/plot/svg.h"

namespace palp {

inline constexpr double kColourBarWidth = 100; ///< with its labels [px]

/// The content of a colour bar.
struct ColourBar {
    const Axis*                 axis = nullptr;
    std::function<Rgb8(double)> colour;   ///< of a position along the axis, 0 to 1 [1]
    std::string_view            quantity; ///< title, without the unit
    std::optional<ValueRange>   values;   ///< found in the data; beyond the axis they get an arrow head
};

/// Draws an upright colour bar with ticks and title.
void drawColourBar(SvgDrawing& svg, const ColourBar& bar, glm::dvec2 corner, double height);

} // namespace palp
