#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/tools/plot/colour_map.h"

namespace palp {

/// An opaque picture, rows from the top.
struct Image {
    Image(int widthPx, int heightPx, Rgb8 fill = {255, 255, 255})
        : width(widthPx), height(heightPx), pixels(std::size_t(widthPx) * std::size_t(heightPx), fill)
    {
    }
    Rgb8&       at(int x, int y) { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
    const Rgb8& at(int x, int y) const { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }

    int               width  = 0; ///< [px]
    int               height = 0; ///< [px]
    std::vector<Rgb8> pixels;     ///< row by row
};

/// Encodes a picture as the bytes of a PNG file: 8 bit RGB, sRGB by convention. Same picture, same bytes.
/// \pre 1 to 2^26 pixels
[[nodiscard]] std::string encodePng(const Image& image);

/// \source RFC 4648, section 4, with padding
[[nodiscard]] std::string base64(std::string_view bytes);

} // namespace palp
