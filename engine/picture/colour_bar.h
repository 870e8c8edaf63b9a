#pragma once
#include <optional>
#include <string_view>

#include "engine/picture/axis.h"
#include "engine/picture/colour_map.h"
#include "engine/picture/svg.h"

namespace palp {

inline constexpr double kColourBarWidth = 100; ///< with its labels [px]

/// An upright colour bar with ticks and title. An arrow head at an end says that values go beyond it.
/// \param values  the values shown, nullopt for none
void drawColourBar(SvgDrawing& svg, const Axis& axis, ColourMap map, std::string_view quantity,
                   std::optional<ValueRange> values, glm::dvec2 corner, double height);

} // namespace palp
