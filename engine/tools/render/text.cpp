#include "engine/tools/render/text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/contract.h"

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

// The file that CMake found, as it is.
__asm__(".section .rodata\n"
        ".global palp_font_begin\n"
        ".balign 16\n"
        "palp_font_begin:\n"
        ".incbin \"" PALPATE_FONT "\"\n"
        ".global palp_font_end\n"
        "palp_font_end:\n"
        ".byte 0\n"
        ".text\n");
extern "C" const unsigned char palp_font_begin[], palp_font_end[];

namespace palp {
namespace {

const stbtt_fontinfo& font()
{
    static const stbtt_fontinfo kFont = [] {
        stbtt_fontinfo info;
        PALP_EXPECT(stbtt_InitFont(&info, palp_font_begin, 0) != 0, "the font of this build is not one");
        return info;
    }();
    return kFont;
}

/// Code points of valid UTF-8; U+FFFD for a byte that is not part of one.
std::vector<int> codePoints(std::string_view text)
{
    std::vector<int> result;
    for (std::size_t n = 0; n < text.size();) {
        const auto        lead   = static_cast<unsigned char>(text[n]);
        const std::size_t length = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 0;
        if (length == 0 || n + length > text.size()) {
            result.push_back(0xFFFD);
            ++n;
            continue;
        }
        int code = length == 1 ? lead : lead & (0xFF >> (length + 1));
        for (std::size_t k = 1; k < length; ++k) code = code << 6 | (text[n + k] & 0x3F);
        result.push_back(code);
        n += length;
    }
    return result;
}

double scaleFor(double size)
{
    return double(stbtt_ScaleForMappingEmToPixels(&font(), float(size)));
}

/// Advance after a character, with the kerning before the next [px].
double advance(int code, int next, double scale)
{
    int wide = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&font(), code, &wide, &bearing);
    return scale * (wide + (next ? stbtt_GetCodepointKernAdvance(&font(), code, next) : 0));
}

void blend(Rgb8& pixel, Rgb8 colour, int cover)
{
    const auto mixed = [cover](int under, int over) {
        return std::uint8_t((under * (255 - cover) + over * cover + 127) / 255);
    };
    pixel = {mixed(pixel.red, colour.red), mixed(pixel.green, colour.green), mixed(pixel.blue, colour.blue)};
}

void drawGlyph(Image& image, glm::dvec2 at, int code, double scale, Rgb8 colour)
{
    const double left = std::floor(at.x), top = std::floor(at.y);
    int          x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    const float  s = float(scale), shiftX = float(at.x - left), shiftY = float(at.y - top);
    stbtt_GetCodepointBitmapBoxSubpixel(&font(), code, s, s, shiftX, shiftY, &x0, &y0, &x1, &y1);
    const int width = x1 - x0, height = y1 - y0;
    if (width <= 0 || height <= 0) return;
    std::vector<unsigned char> cover(std::size_t(width) * std::size_t(height));
    stbtt_MakeCodepointBitmapSubpixel(&font(), cover.data(), width, height, width, s, s, shiftX, shiftY, code);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int px = int(left) + x0 + x, py = int(top) + y0 + y;
            if (px >= 0 && py >= 0 && px < image.width && py < image.height)
                blend(image.at(px, py), colour, cover[std::size_t(y) * std::size_t(width) + std::size_t(x)]);
        }
}

} // namespace

double widthOfText(std::string_view text, double size)
{
    const std::vector<int> codes = codePoints(text);
    const double           scale = scaleFor(size);
    double                 width = 0;
    for (std::size_t n = 0; n < codes.size(); ++n)
        width += advance(codes[n], n + 1 < codes.size() ? codes[n + 1] : 0, scale);
    return width;
}

void drawText(Image& image, glm::dvec2 at, std::string_view text, const TextLine& line)
{
    const std::vector<int> codes = codePoints(text);
    const double           scale = scaleFor(line.size), width = widthOfText(text, line.size);
    at.x -= line.anchor == Anchor::end ? width : line.anchor == Anchor::middle ? width / 2 : 0;
    for (std::size_t n = 0; n < codes.size(); ++n) {
        drawGlyph(image, at, codes[n], scale, line.colour);
        at.x += advance(codes[n], n + 1 < codes.size() ? codes[n + 1] : 0, scale);
    }
}

std::span<const unsigned char> fontBytes() noexcept
{
    return {palp_font_begin, palp_font_end};
}

} // namespace palp
