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

double linearFromSrgb(double coded)
{
    return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

double srgbFromLinear(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint8_t byteOf(double unit)
{
    return std::uint8_t(std::lround(255 * std::clamp(unit, 0.0, 1.0)));
}

// Own map, by formula: a straight line in CIELAB from a dark blue to a light yellow. Lightness grows linearly, and blue
// against yellow is the difference that red-green colour-blind readers see. The ends are as far out as sRGB reaches.
Rgb8 blueYellowAt(double t)
{
    constexpr double kDark[3]  = {14, 16, -40};            // L*, a*, b* [1]
    constexpr double kLight[3] = {92, -10, 68};            // L*, a*, b* [1]
    constexpr double kWhiteX = 0.95047, kWhiteZ = 1.08883; // D65 white at Y = 1 [1]
    const auto       along   = [&](int k) { return kDark[k] + t * (kLight[k] - kDark[k]); };
    const auto       inverse = [](double f) {
        constexpr double kKnee = 6.0 / 29;
        return f > kKnee ? f * f * f : 3 * kKnee * kKnee * (f - 4.0 / 29);
    };
    const double fy = (along(0) + 16) / 116;
    const double x = kWhiteX * inverse(fy + along(1) / 500), y = inverse(fy),
                 z = kWhiteZ * inverse(fy - along(2) / 200);
    return {byteOf(srgbFromLinear(3.2404542 * x - 1.5371385 * y - 0.4985314 * z)),
            byteOf(srgbFromLinear(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z)),
            byteOf(srgbFromLinear(0.0556434 * x - 0.2040259 * y + 1.0572252 * z))};
}

Rgb8 viridisAt(double t)
{
    const double      along = t * double(kViridis.size() - 1);
    const std::size_t left  = std::min(std::size_t(along), kViridis.size() - 2);
    const double      rest  = along - double(left);
    const Rgb8        a = kViridis[left], b = kViridis[left + 1];
    const auto mix = [rest](std::uint8_t from, std::uint8_t to) { return byteOf((from + rest * (to - from)) / 255); };
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

} // namespace

Rgb8 colourAt(ColourMap map, double position)
{
    PALP_EXPECT(!std::isnan(position), "a position along a colour map is a number; found NaN");
    const double t = std::clamp(position, 0.0, 1.0);
    switch (map) {
    case ColourMap::viridis:
        return viridisAt(t);
    case ColourMap::blueYellow:
        return blueYellowAt(t);
    case ColourMap::grey:
        break;
    }
    return {byteOf(t), byteOf(t), byteOf(t)};
}

std::string hexColour(Rgb8 colour)
{
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", colour.red, colour.green, colour.blue);
    return text;
}

double lightness(Rgb8 colour)
{
    const double y = 0.2126729 * linearFromSrgb(colour.red / 255.0) + 0.7151522 * linearFromSrgb(colour.green / 255.0) +
                     0.0721750 * linearFromSrgb(colour.blue / 255.0);
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

} // namespace palp
