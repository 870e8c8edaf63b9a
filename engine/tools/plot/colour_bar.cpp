#include "engine/tools/plot/colour_bar.h"

#include <algorithm>

namespace palp {

void drawColourBar(SvgDrawing& svg, const ColourBar& bar, glm::dvec2 corner, double height)
{
    constexpr double kBar = 16, kTick = 5, kMinorTick = 3, kHead = 11; // [px]
    constexpr int    kColours = 256;
    const Axis&      axis     = *bar.axis;
    const auto&      values   = bar.values;
    const Stroke     edge     = {"#1a1a1a", 1};

    Image colours(1, kColours);
    for (int y = 0; y < kColours; ++y) colours.at(0, y) = bar.colour(1 - (y + 0.5) / kColours);
    svg.image(corner, {kBar, height}, colours);
    svg.rectangle(corner, {kBar, height}, "none", edge);
    const auto head = [](glm::dvec2 left, double towards) {
        return SvgPath({left, left + glm::dvec2(kBar / 2, towards), left + glm::dvec2(kBar, 0)}).close();
    };
    const double over = 1e-9 * (axis.range().high - axis.range().low);
    if (values && values->high > axis.range().high + over)
        svg.path(head(corner, -kHead), hexColour(bar.colour(1)), edge);
    if (values && values->low < axis.range().low - over)
        svg.path(head(corner + glm::dvec2(0, height), kHead), hexColour(bar.colour(0)), edge);

    const auto at     = [&](double value) { return corner + glm::dvec2(kBar, height * (1 - axis.position(value))); };
    double     widest = 0;
    for (double value : axis.minorTicks()) svg.line(at(value), at(value) + glm::dvec2(kMinorTick, 0), {"#1a1a1a", 0.7});
    for (const Tick& tick : axis.ticks()) {
        svg.line(at(tick.value), at(tick.value) + glm::dvec2(kTick, 0), edge);
        svg.text(at(tick.value) + glm::dvec2(kTick + 4, 4.2), tick.label);
        widest = std::max(widest, textWidth(tick.label, 12));
    }
    svg.text(corner + glm::dvec2(kBar + kTick + 20 + widest, height / 2), axis.title(bar.quantity),
             {.size = 13, .anchor = Anchor::middle, .upright = false});
}

} // namespace palp
