#pragma once
#include <span>
#include <string_view>

#include <glm/vec2.hpp>

#include "engine/tools/plot/png.h"
#include "engine/tools/plot/svg.h"

namespace palp {

/// A line of UTF-8 in DejaVu Sans, whose glyphs are part of the program: no font is looked for when it runs, and the
/// same text gives the same pixels. Characters that the font lacks become its empty box.
struct TextLine {
    double size   = 16; ///< of the font [px]
    Rgb8   colour = {26, 26, 26};
    Anchor anchor = Anchor::start;
};

/// \param at  start, middle or end of the line on its baseline [px]; text outside the picture is cut off
void drawText(Image& image, glm::dvec2 at, std::string_view text, const TextLine& line);

/// Returns the width from the first character's start to the last one's end [px].
[[nodiscard]] double widthOfText(std::string_view text, double size);

/// Returns the font itself, a TrueType file.
[[nodiscard]] std::span<const unsigned char> fontBytes() noexcept;

} // namespace palp
