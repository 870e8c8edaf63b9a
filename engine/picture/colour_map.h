#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <string>

namespace palp {

/// One colour, 8 bit sRGB.
struct Rgb8 {
    std::uint8_t red = 0, green = 0, blue = 0;
    auto         operator<=>(const Rgb8&) const = default;
};

/// Colours for a value on a scale from low (dark) to high (light). The lightness of every map grows steadily, so that
/// each is still in order when printed in grey and for every kind of colour vision.
enum class ColourMap {
    viridis,    ///< dark violet, green, yellow
    blueYellow, ///< dark blue, grey, yellow: no red against green anywhere
    grey,       ///< black to white
};

/// The colour at `position` along a map; positions outside [0, 1] take the colour of the nearer end.
/// \param position  [1], not NaN
[[nodiscard]] Rgb8 colourAt(ColourMap map, double position);

/// "#rrggbb"
[[nodiscard]] std::string hexColour(Rgb8 colour);

/// CIE lightness L* of a colour: 0 is black, 100 is white. [1]
[[nodiscard]] double lightness(Rgb8 colour);

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

/// Stands for values that cannot be drawn (NaN, infinity); in no map but the grey one.
inline constexpr Rgb8 kUndefinedColour = {190, 190, 190};

} // namespace palp
