#include <imgui.h>

#include "engine/tools/gui/key_bindings.h"
#include "engine/tools/gui/panel_parts.h"

namespace palp {
namespace {

constexpr float kTwoColumns = 650; ///< least width of a window that shows two, at scale 1 [px]; a higher sheet scrolls

void drawLines(const PanelDesk& desk, const char* title, KeyGroup group)
{
    toned(desk, Tone::accent, title);
    for (const KeyLine& line : keyLines(desk.state.blind)) {
        if (line.group != group) continue;
        ImGui::TextUnformatted(line.keys.c_str());
        ImGui::SameLine(150 * desk.scale, 0); // from the start of the group
        toned(desk, Tone::faint, line.help);
    }
    ImGui::NewLine();
}

} // namespace

void drawKeySheet(PanelDesk& desk)
{
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowBgAlpha(0.98F); // nearly opaque, to be read
    ImGui::SetNextWindowPos(ImVec2(screen.x / 2, screen.y / 2), ImGuiCond_Always, ImVec2(0.5F, 0.5F));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(screen.x, screen.y));
    if (ImGui::Begin("Keys", &desk.state.keys,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove)) {
        const float column = 330 * desk.scale;
        ImGui::BeginGroup();
        drawLines(desk, "look", KeyGroup::view);
        drawLines(desk, "show", KeyGroup::show);
        ImGui::EndGroup();
        if (screen.x >= kTwoColumns * desk.scale) ImGui::SameLine(column);
        ImGui::BeginGroup();
        drawLines(desk, "touch and paint", KeyGroup::touch);
        drawLines(desk, "program", KeyGroup::program);
        ImGui::EndGroup();
    }
    ImGui::End();
}

} // namespace palp
