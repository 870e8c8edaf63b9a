#include "engine/tools/plot/legend.h"

#include <initializer_list>

namespace palp {

void drawSymbol(SvgDrawing& svg, Symbol symbol, glm::dvec2 at, double radius, std::string_view colour)
{
    const auto corners = [&](std::initializer_list<glm::dvec2> points) {
        SvgPath outline;
        for (glm::dvec2 p : points) outline.lineTo(at + radius * p);
        return outline.close();
    };
    const auto strokes = [&](glm::dvec2 a, glm::dvec2 b) {
        const SvgPath bars =
            SvgPath().moveTo(at - radius * a).lineTo(at + radius * a).moveTo(at - radius * b).lineTo(at + radius * b);
        svg.path(bars, "none", {"#ffffff", 0.45 * radius + 2});
        svg.path(bars, "none", {std::string(colour), 0.45 * radius});
    };
    const auto shape = [&](const SvgPath& outline) { svg.path(outline, colour, {"#ffffff", 1}); };

    switch (symbol) {
    case Symbol::circle:
        return svg.circle(at, radius, colour, {"#ffffff", 1});
    case Symbol::square:
        return shape(corners({{-0.88, -0.88}, {0.88, -0.88}, {0.88, 0.88}, {-0.88, 0.88}}));
    case Symbol::triangleUp:
        return shape(corners({{0, -1.15}, {1.05, 0.75}, {-1.05, 0.75}}));
    case Symbol::triangleDown:
        return shape(corners({{0, 1.15}, {1.05, -0.75}, {-1.05, -0.75}}));
    case Symbol::diamond:
        return shape(corners({{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}}));
    case Symbol::cross:
        return strokes({0.85, 0.85}, {0.85, -0.85});
    case Symbol::plus:
        return strokes({1.1, 0}, {0, 1.1});
    }
}

double drawLegend(SvgDrawing& svg, const std::vector<LegendEntry>& entries, glm::dvec2 corner, double width)
{
    constexpr double kRow = 19, kGap = 6, kBetween = 18, kSize = 12; // [px]
    if (entries.empty()) return 0;
    double x = 0, y = kRow / 2;
    for (const LegendEntry& entry : entries) {
        const double needed = kLegendMarkWidth + kGap + textWidth(entry.text, kSize);
        if (x > 0 && x + needed > width) x = 0, y += kRow;
        entry.draw(svg, corner + glm::dvec2(x + kLegendMarkWidth / 2, y));
        svg.text(corner + glm::dvec2(x + kLegendMarkWidth + kGap, y + 0.36 * kSize), entry.text, {.size = kSize});
        x += needed + kBetween;
    }
    return y + kRow / 2;
}

} // namespace palp
