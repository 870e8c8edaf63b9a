#include "engine/tools/gui/panel_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <imgui.h>

namespace palp {
namespace {

constexpr float kGutter     = 34; ///< left of a plot, for its numbers, at scale 1 [px]
constexpr float kMostTick   = 18; ///< of the height that a number along y takes, at scale 1 [px]
constexpr float kDash       = 4;  ///< of a dashed stroke, at scale 1 [px]
constexpr int   kTicksAlong = 5;  ///< numbers below a plot, at most

ImVec2 vec(const glm::vec2& v)
{
    return {v.x, v.y};
}

} // namespace

double roundEnd(double value, double least)
{
    const double most   = drawable(value, Scale::linear) ? std::max(value, least) : least;
    const double decade = std::pow(10.0, std::floor(std::log10(most)));
    for (const double digit : {1.0, 2.0, 3.0, 5.0})
        if (digit * decade >= most * (1 - 1e-9)) return digit * decade; // allows for rounding of the decade
    return 10 * decade;
}

PanelPlot::PanelPlot(const PanelDesk& desk, const PanelPlotSettings& settings)
    : desk_(desk), x_(settings.x, settings.xScale, "", kTicksAlong),
      y_(settings.y, Scale::linear, "", int(settings.height / kMostTick)), down_(settings.yDown)
{
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float  s = desk.scale, font = ImGui::GetFontSize();
    low_       = {at.x + kGutter * s, at.y + 0.3F * font};
    high_      = {at.x + ImGui::GetContentRegionAvail().x - 0.5F * font, low_.y + settings.height * s};
    legendEnd_ = high_.x - 4 * s;
    ImGui::InvisibleButton(settings.title, ImVec2(high_.x + 0.5F * font - at.x, high_.y + 1.05F * font - at.y));
    pointed_ = ImGui::IsItemHovered();
    drawFrame(settings);
}

glm::vec2 PanelPlot::pixel(double x, double y) const
{
    // Keeps places near the frame, even for values that are not numbers, so that no infinity is drawn.
    const auto       near = [](double share) { return std::isnan(share) ? 0.0 : std::clamp(share, -1.0, 2.0); };
    const double     up   = near(y_.position(y));
    const glm::dvec2 share(near(x_.position(x)), down_ ? up : 1 - up);
    return low_ + glm::vec2(share) * (high_ - low_);
}

void PanelPlot::drawFrame(const PanelPlotSettings& settings) const
{
    ImDrawList* const   draw = ImGui::GetWindowDrawList();
    const float         s = desk_.scale, font = ImGui::GetFontSize();
    const Rgb8          ink  = inkOn(desk_.state.look.ground);
    const std::uint32_t text = packed(colourOf(Tone::faint, desk_.dark())), grid = packed(ink, 0.14);
    draw->AddRectFilled(vec(low_), vec(high_), packed(ink, 0.03));
    // Goes from the right: the last number has the unit, and ticks without room for a number have only their line.
    float free = high_.x + 0.5F * font;
    for (auto tick = x_.ticks().rbegin(); tick != x_.ticks().rend(); ++tick) {
        const float       at    = pixel(tick->value, y_.range().low).x;
        const std::string label = tick == x_.ticks().rbegin() ? tick->label + " " + settings.xUnit : tick->label;
        const float       wide  = ImGui::CalcTextSize(label.c_str()).x;
        const float       left  = std::min(at - wide / 2, high_.x + 0.5F * font - wide);
        draw->AddLine(ImVec2(at, low_.y), ImVec2(at, high_.y), grid, 1);
        if (left + wide > free) continue;
        draw->AddText(ImVec2(left, high_.y + 1), text, label.c_str());
        free = left - 0.4F * font;
    }
    for (const Tick& tick : y_.ticks()) {
        const float at = pixel(x_.range().low, tick.value).y, wide = ImGui::CalcTextSize(tick.label.c_str()).x;
        draw->AddLine(ImVec2(low_.x, at), ImVec2(high_.x, at), grid, 1);
        if (settings.yNumbers)
            draw->AddText(ImVec2(low_.x - 4 * s - wide, at - 0.52F * font), text, tick.label.c_str());
    }
    draw->AddRect(vec(low_), vec(high_), packed(ink, 0.35));
    draw->AddText(ImVec2(low_.x + 4 * s, low_.y + 1), packed(ink), settings.title);
}

void PanelPlot::line(const glm::vec2& from, const glm::vec2& to, Tone tone, Stroke stroke) const
{
    ImDrawList* const   draw = ImGui::GetWindowDrawList();
    const std::uint32_t ink  = packed(colourOf(tone, desk_.dark()));
    if (stroke == Stroke::whole) {
        draw->AddLine(vec(from), vec(to), ink, 1.5F * desk_.scale);
        return;
    }
    // Dashes follow the place along x, so that those of neighbouring pieces join.
    const float dash = kDash * desk_.scale;
    for (float at = std::floor((from.x - low_.x) / (2 * dash)) * 2 * dash + low_.x; at < to.x; at += 2 * dash) {
        const float a = std::max(at, from.x), b = std::min(at + dash, to.x), run = to.x - from.x;
        if (b <= a || run <= 0) continue;
        draw->AddLine(ImVec2(a, from.y + (to.y - from.y) * (a - from.x) / run),
                      ImVec2(b, from.y + (to.y - from.y) * (b - from.x) / run), ink, 1.5F * desk_.scale);
    }
}

void PanelPlot::curve(std::span<const float> values, double first, double step, Tone tone, Stroke stroke)
{
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(vec(low_), vec(high_), true);
    std::vector<ImVec2> points;
    points.reserve(values.size());
    for (std::size_t n = 0; n < values.size(); ++n)
        points.push_back(vec(pixel(first + step * double(n), double(values[n]))));
    if (stroke == Stroke::whole)
        draw->AddPolyline(points.data(), int(points.size()), packed(colourOf(tone, desk_.dark())), 0,
                          1.5F * desk_.scale);
    else
        for (std::size_t n = 1; n < points.size(); ++n)
            line({points[n - 1].x, points[n - 1].y}, {points[n].x, points[n].y}, tone, stroke);
    draw->PopClipRect();
}

void PanelPlot::bars(std::span<const float> heights, Tone tone)
{
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const float       wide = (high_.x - low_.x) / float(heights.size());
    for (std::size_t n = 0; n < heights.size(); ++n) {
        if (heights[n] <= 0) continue;
        const float top =
            std::min(pixel(x_.range().low, double(heights[n])).y, high_.y - desk_.scale); // at least one line high
        draw->AddRectFilled(ImVec2(low_.x + wide * float(n), top), ImVec2(low_.x + wide * float(n + 1) - 1, high_.y),
                            packed(colourOf(tone, desk_.dark())));
    }
}

void PanelPlot::mark(double x, Tone tone)
{
    const float at = pixel(x, y_.range().low).x;
    ImGui::GetWindowDrawList()->AddLine(ImVec2(at, low_.y + 1.2F * ImGui::GetFontSize()), ImVec2(at, high_.y),
                                        packed(colourOf(tone, desk_.dark())), 1.5F * desk_.scale);
}

void PanelPlot::legend(const char* text, Tone tone, Stroke stroke)
{
    const float s = desk_.scale, font = ImGui::GetFontSize(), wide = ImGui::CalcTextSize(text).x, mark = 16 * s;
    const float y = low_.y + 1 + 0.55F * font;
    ImGui::GetWindowDrawList()->AddText(ImVec2(legendEnd_ - wide, low_.y + 1), packed(inkOn(desk_.state.look.ground)),
                                        text);
    legendEnd_ -= wide + 4 * s;
    line({legendEnd_ - mark, y}, {legendEnd_, y}, tone, stroke);
    legendEnd_ -= mark + 8 * s;
}

std::optional<glm::dvec2> PanelPlot::pointed() const
{
    const ImVec2 mouse = ImGui::GetMousePos();
    if (!pointed_ || mouse.x < low_.x || mouse.x > high_.x || mouse.y < low_.y || mouse.y > high_.y) return {};
    const glm::dvec2 share = (glm::dvec2(mouse.x, mouse.y) - glm::dvec2(low_)) / glm::dvec2(high_ - low_);
    const auto       along = [](const Axis& axis, double at) {
        const ValueRange range = axis.range();
        return axis.scale() == Scale::linear ? range.low + (range.high - range.low) * at
                                                   : range.low * std::pow(range.high / range.low, at);
    };
    return glm::dvec2(along(x_, share.x), along(y_, down_ ? share.y : 1 - share.y));
}

} // namespace palp
