#include "engine/tools/gui/panel_parts.h"

#include <cfloat>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include <imgui.h>

#include "engine/session/servo.h"

namespace palp {
namespace {

constexpr float kLabelWidth = 92;  ///< of labels before controls, at scale 1 [px]
constexpr float kTipWidth   = 280; ///< of a tip's text, at scale 1 [px]

ImVec4 floats(Rgb8 colour)
{
    return ImGui::ColorConvertU32ToFloat4(packed(colour));
}

/// Returns black or white, whichever has more contrast.
/// \source Rec. 601 luma
Rgb8 inkOver(Rgb8 fill)
{
    const int luma = 299 * fill.red + 587 * fill.green + 114 * fill.blue; // of 255 000
    return luma > 140'000 ? Rgb8{20, 20, 20} : Rgb8{255, 255, 255};
}

/// Writes a label at `from` and its number ending at `to`, both from the window's left edge [px].
void readingBetween(const PanelDesk& desk, float from, float to, const char* label, std::string_view value, Tone tone)
{
    ImGui::SetCursorPosX(from);
    toned(desk, Tone::faint, label);
    ImGui::SameLine(to - ImGui::CalcTextSize(value.data(), value.data() + value.size()).x, 0);
    toned(desk, tone, value);
}

} // namespace

Rgb8 colourOf(Tone tone, bool dark)
{
    switch (tone) {
    case Tone::plain:
        break;
    case Tone::faint:
        return dark ? Rgb8{160, 166, 174} : Rgb8{92, 98, 106};
    case Tone::accent:
        return dark ? kNamedColours[5] : kNamedColours[0];
    case Tone::second:
        return dark ? kNamedColours[4] : kNamedColours[1];
    case Tone::good:
        return dark ? Rgb8{64, 200, 150} : Rgb8{0, 120, 88};
    case Tone::warning:
        return dark ? Rgb8{245, 185, 80} : Rgb8{150, 84, 0};
    case Tone::fault:
        return dark ? Rgb8{255, 120, 110} : Rgb8{186, 16, 16};
    }
    return inkOn(dark ? Ground::dark : Ground::light);
}

std::uint32_t packed(Rgb8 colour, double alpha)
{
    return IM_COL32(colour.red, colour.green, colour.blue, int(255 * alpha + 0.5));
}

std::string formatted(const char* format, ...)
{
    char         text[256];
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return text;
}

void toned(const PanelDesk& desk, Tone tone, std::string_view text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, floats(colourOf(tone, desk.dark())));
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    ImGui::PopStyleColor();
}

void tonedWrapped(const PanelDesk& desk, Tone tone, std::string_view text)
{
    ImGui::PushTextWrapPos(0);
    toned(desk, tone, text);
    ImGui::PopTextWrapPos();
}

void labelled(const PanelDesk& desk, const char* label, const char* means)
{
    ImGui::AlignTextToFramePadding();
    toned(desk, Tone::faint, label);
    if (means) tip(means);
    ImGui::SameLine(kLabelWidth * desk.scale + ImGui::GetStyle().WindowPadding.x, 0);
    ImGui::SetNextItemWidth(-FLT_MIN);
}

void reading(const PanelDesk& desk, Half half, const char* label, std::string_view value, Tone tone)
{
    const float left = ImGui::GetWindowContentRegionMin().x, right = ImGui::GetWindowContentRegionMax().x;
    const float gap = 8 * desk.scale, middle = (left + right) / 2;
    if (half == Half::left) return readingBetween(desk, left, middle - gap, label, value, tone);
    ImGui::SameLine();
    readingBetween(desk, middle + gap, right, label, value, tone);
}

void reading(const PanelDesk& desk, const char* label, std::string_view value, Tone tone)
{
    readingBetween(desk, ImGui::GetWindowContentRegionMin().x, ImGui::GetWindowContentRegionMax().x, label, value,
                   tone);
}

void readingOfAge(const PanelDesk& desk, Half half, const char* label)
{
    const TickRecord& now   = desk.content.history.newest();
    const bool        stale = (now.faults & static_cast<std::uint32_t>(SessionFlag::stalePatch)) != 0;
    if (!desk.content.touching || !(now.compliance > 0) || !std::isfinite(now.patchAge))
        return reading(desk, half, label, "\u2013");
    constexpr double  kOld = 10; // [s] age beyond which the number is not shown
    const std::string age  = now.patchAge < kOld ? formatted("%.0f ms", 1e3 * now.patchAge) : "> 10 s";
    reading(desk, half, label, stale ? age + " stale" : age, stale ? Tone::warning : Tone::good);
}

std::optional<int> segments(const PanelDesk& desk, const char* id, int chosen, std::initializer_list<const char*> names)
{
    const float gap   = ImGui::GetStyle().ItemInnerSpacing.x / 2;
    float       texts = 0; // [px]
    for (const char* name : names) texts += ImGui::CalcTextSize(name).x;
    const float spare = (ImGui::GetContentRegionAvail().x - gap * float(names.size() - 1) - texts) /
                        float(names.size()); // beside each text [px]
    std::optional<int> clicked;
    int                n    = 0;
    const Rgb8         fill = colourOf(Tone::accent, desk.dark());
    ImGui::PushID(id);
    for (const char* name : names) {
        if (n > 0) ImGui::SameLine(0, gap);
        const bool is = n == chosen;
        if (is) {
            for (const ImGuiCol part : {ImGuiCol_Button, ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive})
                ImGui::PushStyleColor(part, floats(fill));
            ImGui::PushStyleColor(ImGuiCol_Text, floats(inkOver(fill)));
        }
        if (ImGui::Button(name, ImVec2(ImGui::CalcTextSize(name).x + spare, 0)) && !is) clicked = n;
        if (is) ImGui::PopStyleColor(4);
        ++n;
    }
    ImGui::PopID();
    return clicked;
}

void badge(const char* text, Rgb8 fill)
{
    const ImVec2 size = ImGui::CalcTextSize(text);
    const float  pad  = 0.4F * ImGui::GetFontSize();
    const ImVec2 at   = ImGui::GetCursorScreenPos();
    const ImVec2 end(at.x + size.x + 2 * pad, at.y + size.y);
    ImDrawList*  draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, end, packed(fill), 0.25F * size.y);
    draw->AddText(ImVec2(at.x + pad, at.y), packed(inkOver(fill)), text);
    ImGui::Dummy(ImVec2(end.x - at.x, size.y));
}

void tip(const char* text)
{
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(kTipWidth * ImGui::GetFontSize() / 15);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool buttonIf(bool enabled, const char* label, const char* what)
{
    ImGui::BeginDisabled(!enabled);
    const bool pressed = ImGui::Button(label);
    ImGui::EndDisabled();
    tip(what);
    return pressed;
}

} // namespace palp
