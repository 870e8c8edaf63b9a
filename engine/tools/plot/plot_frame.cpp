#include "engine/tools/plot/plot_frame.h"

#include <algorithm>

namespace palp {
namespace {

const Stroke kInk = {"#1a1a1a", 1};

} // namespace

void drawGridLines(SvgDrawing& svg, const PlotFrame& frame)
{
    const Stroke pale = {"#e4e4e4", 1};
    for (const Tick& tick : frame.x.ticks()) {
        const double x = frame.pixelX(tick.value);
        svg.line({x, frame.corner.y}, {x, frame.corner.y + frame.size.y}, pale);
    }
    for (const Tick& tick : frame.y.ticks()) {
        const double y = frame.pixelY(tick.value);
        svg.line({frame.corner.x, y}, {frame.corner.x + frame.size.x, y}, pale);
    }
}

void drawFrame(SvgDrawing& svg, const PlotFrame& frame, std::string_view quantityX, std::string_view quantityY)
{
    constexpr double kTick = 5, kMinorTick = 3, kLabel = 12, kTitle = 13; // [px]
    const double     left = frame.corner.x, bottom = frame.corner.y + frame.size.y;
    svg.rectangle(frame.corner, frame.size, "none", kInk);
    for (double value : frame.x.minorTicks()) {
        const double x = frame.pixelX(value);
        svg.line({x, bottom}, {x, bottom + kMinorTick}, kInk);
    }
    for (const Tick& tick : frame.x.ticks()) {
        const double x = frame.pixelX(tick.value);
        svg.line({x, bottom}, {x, bottom + kTick}, kInk);
        svg.text({x, bottom + kTick + 14}, tick.label, {.size = kLabel, .anchor = Anchor::middle});
    }
    double widest = 0;
    for (double value : frame.y.minorTicks()) {
        const double y = frame.pixelY(value);
        svg.line({left - kMinorTick, y}, {left, y}, kInk);
    }
    for (const Tick& tick : frame.y.ticks()) {
        const double y = frame.pixelY(tick.value);
        svg.line({left - kTick, y}, {left, y}, kInk);
        svg.text({left - kTick - 4, y + 4.2}, tick.label, {.size = kLabel, .anchor = Anchor::end});
        widest = std::max(widest, textWidth(tick.label, kLabel));
    }
    svg.text({left + frame.size.x / 2, bottom + 40}, frame.x.title(quantityX),
             {.size = kTitle, .anchor = Anchor::middle});
    svg.text({std::max(14.0, left - kTick - 12 - widest), frame.corner.y + frame.size.y / 2}, frame.y.title(quantityY),
             {.size = kTitle, .anchor = Anchor::middle, .upright = false});
}

} // namespace palp
