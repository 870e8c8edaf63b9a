#include "engine/tools/gui/panels.h"

#include <algorithm>
#include <string>

#include <imgui.h>

#include "engine/tools/gui/panel_layout.h"
#include "engine/tools/gui/panel_parts.h"
#include "engine/tools/gui/touch_faults.h"

namespace palp {
namespace {

/// A window smaller than this has sections closed at first [px at scale 1].
constexpr float kSmallWidth = 700, kSmallHeight = 480;

/// Sets a compact style: less room around everything than Dear ImGui's own.
class Style {
public:
    Style(bool dark, float s)
    {
        const auto size = [s](float x, float y) { return ImVec2(x * s, y * s); };
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, size(8, 6));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, size(5, 1));
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, size(6, 4));
        ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 8 * s);
        ImGui::PushStyleVar(ImGuiStyleVar_ScrollbarSize, 10 * s);
        ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
        const Rgb8 ink = inkOn(dark ? Ground::dark : Ground::light), blue = colourOf(Tone::accent, dark);
        // Like the fading below the texts of the picture: it stays slightly visible.
        colour(ImGuiCol_WindowBg, dark ? Rgb8{30, 32, 36} : Rgb8{246, 247, 248}, 0.92);
        colour(ImGuiCol_Text, ink, 1);
        colour(ImGuiCol_FrameBg, ink, 0.10);
        colour(ImGuiCol_FrameBgHovered, blue, 0.25);
        colour(ImGuiCol_FrameBgActive, blue, 0.35);
        colour(ImGuiCol_Button, ink, 0.10);
        colour(ImGuiCol_ButtonHovered, blue, 0.30);
        colour(ImGuiCol_ButtonActive, blue, 0.50);
        colour(ImGuiCol_Header, ink, 0.07);
        colour(ImGuiCol_HeaderHovered, blue, 0.25);
        colour(ImGuiCol_HeaderActive, blue, 0.40);
        colour(ImGuiCol_CheckMark, blue, 1);
        colour(ImGuiCol_SliderGrab, blue, 0.45);
        colour(ImGuiCol_SliderGrabActive, blue, 0.7);
    }
    ~Style()
    {
        ImGui::PopStyleColor(colours_);
        ImGui::PopStyleVar(6);
    }
    Style(const Style&)            = delete;
    Style& operator=(const Style&) = delete;

private:
    void colour(ImGuiCol part, Rgb8 value, double alpha)
    {
        ImGui::PushStyleColor(part, packed(value, alpha));
        ++colours_;
    }

    int colours_ = 0;
};

struct Section {
    const char* title;
    void (*draw)(PanelDesk&);
    float openFrom; ///< height of a window in which it is open at first [px at scale 1]
};

/// As much is open as fits without scrolling; in low windows the touch, since the view can be set by keys too.
constexpr Section kSections[] = {
    {"View", drawViewSection, 700},      {"Touch", drawTouchSection, kSmallHeight}, {"Chart", drawChartSection, 960},
    {"Timing", drawTimingSection, 1180}, {"Scene", drawSceneSection, 1660},
};

bool header(const char* title, bool open)
{
    ImGui::SetNextItemOpen(open, ImGuiCond_Once);
    return ImGui::CollapsingHeader(title);
}

/// Closes the sections when the window has become small, and opens those again when it has grown.
/// \param high  of the window [px at scale 1]
void closeWhileSmall(bool small, float high)
{
    ImGuiStorage* const kept = ImGui::GetStateStorage();
    const ImGuiID       was  = ImGui::GetID("was small");
    if (small == kept->GetBool(was)) return;
    kept->SetBool(was, small);
    const auto toggle = [&](const char* title, float openFrom) {
        const ImGuiID open = ImGui::GetID(title), before = ImGui::GetID((std::string(title) + " before").c_str());
        if (small) {
            kept->SetInt(before, kept->GetInt(open, -1)); // -1: not drawn yet
            kept->SetInt(open, 0);
        } else if (const int then = kept->GetInt(before); then > 0 || (then < 0 && high >= openFrom)) {
            kept->SetInt(open, 1);
        }
    };
    toggle("Paint", 0);
    for (const Section& section : kSections) toggle(section.title, section.openFrom);
}

/// \param top, foot  heights that belong to others [px]
void drawColumn(PanelDesk& desk, float top, float foot)
{
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float  s = desk.scale, wide = columnWidth(screen.x, s);
    const float  most  = std::max(screen.y - top - foot, 4 * ImGui::GetFontSize());
    const bool   small = screen.x < kSmallWidth * s || screen.y < kSmallHeight * s;
    ImGui::SetNextWindowPos(ImVec2(0, top));
    ImGui::SetNextWindowSizeConstraints(ImVec2(wide, 0), ImVec2(wide, most));
    ImGui::SetNextWindowSize(ImVec2(wide, 0)); // as high as the open sections
    if (ImGui::Begin("panels", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        closeWhileSmall(small, screen.y / s);
        if (desk.state.tool == Tool::paint && header("Paint", true)) drawPaintSection(desk);
        for (const Section& section : kSections)
            if (header(section.title, screen.y >= section.openFrom * s)) section.draw(desk);
    }
    ImGui::End();
}

} // namespace

PanelWishes drawPanels(ViewState& state, const PanelContent& content, double scale)
{
    PanelWishes wishes;
    PanelDesk   desk{state, content, wishes, float(scale)};
    const Style style(desk.dark(), desk.scale);
    // A fault is shown even while panels are hidden, so that the user learns why the hand feels nothing: by the note of
    // the picture, or where that has no texts by the status line.
    const bool column = hasColumn(state);
    if (column || (!state.texts && needsAttention(content))) {
        const float  top  = drawStatusLine(desk);
        const ImVec2 all  = ImGui::GetIO().DisplaySize;
        const float  foot = state.texts ? footHeight(all.x, all.y, desk.scale) : 0;
        if (column) drawColumn(desk, top, foot);
    }
    if (state.keys && !state.blind) drawKeySheet(desk);
    return wishes;
}

} // namespace palp
