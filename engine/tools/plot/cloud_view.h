#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/tools/plot/axis.h"
#include "engine/tools/plot/legend.h"

namespace palp {

/// A named place on top of a cloud view. Hollow when the surface hides it.
struct CloudMarker {
    glm::dvec3  position{0}; ///< [m, world]
    std::string label;
    Symbol      symbol = Symbol::circle;
    glm::dvec3  arrow{0}; ///< from the position to the tip [m, world]; zero is none
};

/// The part of the world to show.
struct CloudWindow {
    glm::dvec3 centre{0};     ///< in the middle of the picture [m, world]
    double     halfWidth = 1; ///< from the middle to the left edge [m]
};

struct CloudViewSettings {
    std::string                title;
    std::string                quantity = "displacement"; ///< label of the colour bar
    std::string                unit     = "m";            ///< SI unit of the values; the prefix is chosen
    Scale                      scale    = Scale::linear;
    std::optional<ValueRange>  range; ///< ends of the colours [unit]; absent: the smallest and largest drawable value
    int                        width  = 900;             ///< of the picture without legends [px]
    int                        height = 700;             ///< [px]
    glm::dvec3                 direction{-0.5, 0.6, -1}; ///< in which the eye looks [world], any length
    glm::dvec3                 up{0, 1, 0};              ///< drawn upwards as far as possible [world], any length
    std::optional<CloudWindow> window;                   ///< absent: the whole cloud
    std::vector<CloudMarker>   markers;
};

/// Draws a point cloud as a shaded, closed surface in the colours of a value per point: a self-contained SVG picture
/// with colour bar, scale bar, axes of the world and named markers. No GPU and no display are used.
///
/// Points whose position is not finite, or lies beyond 1e100 m, are left out and counted below the picture. Points
/// whose value cannot be drawn (NaN, infinity, not positive on a logarithmic scale) are grey and counted. No points at
/// all, or none with a position, give an empty picture that says so. Points that all coincide are shown 2 mm wide.
/// Shading darkens the colours, so values read off the picture are a guide only.
/// \param values  empty (one neutral colour, no colour bar), or one per point
/// \pre a picture of 64 to 8192 px a side; direction and up are finite, not zero and not parallel; a window of
///      positive, finite width
[[nodiscard]] std::string cloudViewSvg(std::span<const glm::dvec3> positions, std::span<const double> values,
                                       const CloudViewSettings& settings);

} // namespace palp
