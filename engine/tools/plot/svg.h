#pragma once
#include <initializer_list>
#include <string>

#include <string_view>

#include <glm/vec2.hpp>

#include "engine/tools/plot/png.h"

namespace palp {

/// How a line is drawn. Colours are "#rrggbb" or "none".
struct Stroke {
    std::string colour = "none";
    double      width  = 1;  ///< [px]
    std::string dash   = ""; ///< lengths [px] of strokes and gaps, "6 3"; empty is a full line
};

enum class Anchor { start, middle, end };

struct TextStyle {
    double      size    = 12; ///< [px]
    Anchor      anchor  = Anchor::start;
    std::string colour  = "#1a1a1a";
    bool        bold    = false;
    bool        upright = true;  ///< false: reads upwards
    bool        halo    = false; ///< white edge, for text on top of a picture
};

/// A line from point to point, possibly in several pieces.
class SvgPath {
public:
    SvgPath() = default;
    explicit SvgPath(std::initializer_list<glm::dvec2> corners);
    SvgPath& moveTo(glm::dvec2 point);
    /// Adds a line, or starts the path when it is empty.
    SvgPath& lineTo(glm::dvec2 point);
    SvgPath& dotAt(glm::dvec2 point);
    SvgPath& close();

    [[nodiscard]] const std::string& commands() const noexcept { return commands_; }

private:
    std::string commands_; ///< as of the attribute "d"
};

/// Builds an SVG picture from top to bottom. Coordinates are pixels, y down. Every text is escaped, every number is
/// written without the locale, and no element has an id, so that many pictures fit on one HTML page.
class SvgDrawing {
public:
    void line(glm::dvec2 from, glm::dvec2 to, const Stroke& stroke);
    void rectangle(glm::dvec2 corner, glm::dvec2 size, std::string_view fill, const Stroke& stroke = {});
    void circle(glm::dvec2 centre, double radius, std::string_view fill, const Stroke& stroke = {});
    void path(const SvgPath& path, std::string_view fill, const Stroke& stroke);
    void text(glm::dvec2 at, std::string_view content, const TextStyle& style = {});
    /// Adds a picture, stretched to `size`; its pixels stay sharp when it is enlarged.
    void image(glm::dvec2 corner, glm::dvec2 size, const Image& image);
    /// Clips what follows to the rectangle, until endClip().
    void beginClip(glm::dvec2 corner, glm::dvec2 size);
    void endClip();

    /// Returns the whole file on a white ground (also on a dark page).
    /// \param title  text for screen readers
    [[nodiscard]] std::string finish(glm::dvec2 size, std::string_view title) const;

private:
    std::string body_;
};

/// Returns a number for SVG with at most two decimals: "12.5".
[[nodiscard]] std::string svgNumber(double value);

/// Returns the approximate width of a text, whose font is the viewer's [px].
[[nodiscard]] double textWidth(std::string_view text, double size);

} // namespace palp
