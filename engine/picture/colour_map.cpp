#include "engine/picture/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/core/contract.h"

namespace palp {
namespace {

// viridis by Nathaniel J. Smith, Stefan van der Walt and Eric Firing, dedicated to the public domain (CC0); every 17th
// of its 256 colours. Straight lines between them stay within 8/255 of the full table (in blue, near the yellow end).
constexpr std::array<Rgb8, 16> kViridis = {{
    {68, 1, 84},
    {72, 26, 108},
    {71, 47, 125},
    {65, 68, 135},
    {57, 86, 140},
    {49, 104, 142},
    {42, 120, 142},
    {35, 136, 142},
    {31, 152, 139},
    {34, 168, 132},
    {53, 183, 121},
    {84, 197, 104},
    {122, 209, 81},
    {165, 219, 54},
    {210, 226, 27},
    {253, 231, 37},
}};

std::uint8_t byteOf(double unit)
{
    return std::uint8_t(std::lround(255 * std::clamp(unit, 0.0, 1.0)));
}

} // namespace

Rgb8 colourAt(double position)
{
    PALP_EXPECT(!std::isnan(position), "a position along a colour map is a number; found NaN");
    const double      along = std::clamp(position, 0.0, 1.0) * double(kViridis.size() - 1);
    const std::size_t left  = std::min(std::size_t(along), kViridis.size() - 2);
    const double      rest  = along - double(left);
    const Rgb8        a = kViridis[left], b = kViridis[left + 1];
    const auto mix = [rest](std::uint8_t from, std::uint8_t to) { return byteOf((from + rest * (to - from)) / 255); };
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

std::string hexColour(Rgb8 colour)
{
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", colour.red, colour.green, colour.blue);
    return text;
}

} // namespace palp
