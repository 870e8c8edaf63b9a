#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/enum_names.h"

namespace palp {

/// One colour, 8 bit sRGB.
struct Rgb8 {
    std::uint8_t red = 0, green = 0, blue = 0;
    auto         operator<=>(const Rgb8&) const = default;
};

/// Colours from low to high whose lightness grows steadily, so that they are still in order when printed in grey.
enum class ColourMap {
    viridis, ///< dark violet, green, yellow: in order for every kind of colour vision
    cividis, ///< dark blue, grey, yellow: looks nearly the same to every kind of colour vision
    grey     ///< dark to light
};
constexpr auto namesOf(ColourMap)
{
    using enum ColourMap;
    return std::to_array<NamedValue<ColourMap>>({{viridis, "viridis"}, {cividis, "cividis"}, {grey, "grey"}});
}

/// Returns the colour at a position from low, 0, to high, 1; positions outside take the colour of the nearer end.
/// \param position  along the map, not NaN [1]
[[nodiscard]] Rgb8 colourAt(double position, ColourMap map = ColourMap::viridis);

/// Returns the colour of a value on a lit surface: that of the map, lightened so that shading shows on it.
/// \param position  along the map, 0 to 1 [1]
[[nodiscard]] Rgb8 surfaceColour(double position, ColourMap map = ColourMap::viridis);

/// Returns "#rrggbb".
[[nodiscard]] std::string hexColour(Rgb8 colour);

/// Colours for things that have names rather than values; safe for colour-blind readers, strongest on white first.
/// \source Okabe & Ito 2008, "Color Universal Design", the set of eight without its black
inline constexpr std::array<Rgb8, 7> kNamedColours = {{
    {0, 114, 178},   // blue
    {213, 94, 0},    // vermilion
    {0, 158, 115},   // bluish green
    {204, 121, 167}, // reddish purple
    {230, 159, 0},   // orange
    {86, 180, 233},  // sky blue
    {240, 228, 66},  // yellow
}};

/// Stands for values that cannot be drawn (NaN, infinity); not on the map.
inline constexpr Rgb8 kUndefinedColour = {190, 190, 190};

} // namespace palp
