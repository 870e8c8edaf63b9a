#pragma once
#include <vector>

#include "engine/tools/plot/cloud_surface.h"
#include "engine/tools/plot/colour_map.h"
#include "engine/tools/plot/png.h"

namespace palp {

/// How bright a surface looks per pixel, 1 where it faces the light [1]: diffuse light from the upper left, darker in
/// hollows and behind edges, so that a dent shows although its slope is slight.
/// \source the second part after Luft et al. 2006, "Image enhancement by unsharp masking the depth buffer"
[[nodiscard]] std::vector<float> cloudShading(const CloudSurface& surface);

/// The colour of a value on a surface that faces the light: that of the map, lightened so that shading shows on it.
/// \param position  along the map, 0 to 1 [1]
[[nodiscard]] Rgb8 surfaceColour(double position, ColourMap map = ColourMap::viridis);

enum class Paint {
    values, ///< surfaceColour() of the values, which lie in 0 to 1; grey without one
    clay    ///< one neutral colour
};

/// The shaded surface on white.
[[nodiscard]] Image cloudImage(const CloudSurface& surface, Paint paint);

} // namespace palp
