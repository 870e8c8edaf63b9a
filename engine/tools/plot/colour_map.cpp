#include "engine/tools/plot/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

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

// cividis by Jamie R. Nunez, Christopher R. Anderton and Ryan S. Renslow, "Optimizing colormaps with consideration for
// color vision deficiency to enable accurate interpretation of scientific data", PLOS ONE 2018 (a BSD-style licence of
// Battelle); ten of its 256 colours, evenly spread.
constexpr std::array<Rgb8, 10> kCividis = {{
    {0, 34, 78},
    {18, 53, 112},
    {59, 73, 108},
    {87, 93, 109},
    {112, 113, 115},
    {138, 134, 120},
    {165, 156, 116},
    {195, 179, 105},
    {225, 204, 85},
    {254, 232, 56},
}};

// Not from black to white: a picture's shading and its ground need room beyond both ends.
constexpr std::array<Rgb8, 2> kGrey = {{{45, 45, 45}, {235, 235, 235}}};

std::span<const Rgb8> coloursOf(ColourMap map)
{
    switch (map) {
    case ColourMap::viridis:
        return kViridis;
    case ColourMap::cividis:
        return kCividis;
    case ColourMap::grey:
        return kGrey;
    }
    return kViridis;
}

std::uint8_t byteOf(double unit)
{
    return std::uint8_t(std::lround(255 * std::clamp(unit, 0.0, 1.0)));
}

} // namespace

Rgb8 colourAt(double position, ColourMap map)
{
    PALP_EXPECT(!std::isnan(position), "a position along a colour map is a number; found NaN");
    const auto        colours = coloursOf(map);
    const double      along   = std::clamp(position, 0.0, 1.0) * double(colours.size() - 1);
    const std::size_t left    = std::min(std::size_t(along), colours.size() - 2);
    const double      rest    = along - double(left);
    const Rgb8        a = colours[left], b = colours[left + 1];
    const auto mix = [rest](std::uint8_t from, std::uint8_t to) { return byteOf((from + rest * (to - from)) / 255); };
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

Rgb8 surfaceColour(double position, ColourMap map)
{
    constexpr double kWhite = 0.35; // share of white: the dark end of the map would swallow the shading [1]
    const Rgb8       colour = colourAt(position, map);
    const auto lightened    = [](std::uint8_t c) { return std::uint8_t(std::lround((1 - kWhite) * c + kWhite * 255)); };
    return {lightened(colour.red), lightened(colour.green), lightened(colour.blue)};
}

std::string hexColour(Rgb8 colour)
{
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", colour.red, colour.green, colour.blue);
    return text;
}

} // namespace palp
