#include <imgui.h>

#include "engine/tools/gui/panel_parts.h"

namespace palp {
namespace {

struct KeyLine {
    const char* key;
    const char* does;
};

constexpr KeyLine kPointer[] = {
    {"left drag", "orbit"},
    {"right or shift drag", "pan"},
    {"middle drag", "orbit while painting"},
    {"wheel", "zoom"},
    {"double click", "set the pivot"},
    {"F", "frame the object"},
    {"R", "reset, also a fault"},
    {"O", "orthographic"},
    {"1  3  7", "along the axes"},
};
constexpr KeyLine kTouch[] = {
    {"hold Space or H", "touch; wheel is depth"},
    {"Esc", "let go of the object"},
    {"B", "paint instead of touch"},
    {"[  ]", "size of the brush"},
    {"Ctrl+Z  Ctrl+Y", "undo, redo"},
    {"Ctrl+S", "save what is painted"},
    {"F5", "record"},
    {"F6", "replay the last recording"},
};
constexpr KeyLine kShown[] = {
    {"V", "next quantity in colours"}, {"C", "next colour map"}, {"L", "light or dark"},    {"X", "exaggeration"},
    {"G", "surface at rest"},          {"S", "fitted sphere"},   {"J", "projected points"},
};
constexpr KeyLine kProgram[] = {
    {"Tab", "panels"},
    {"T", "texts"},
    {"P  Shift+P", "picture, with panels"},
    {"F1", "this sheet"},
    {"close the window", "quit"},
};

template <std::size_t n>
void drawLines(const PanelDesk& desk, const char* title, const KeyLine (&lines)[n])
{
    toned(desk, Tone::accent, title);
    for (const KeyLine& line : lines) {
        ImGui::TextUnformatted(line.key);
        ImGui::SameLine(150 * desk.scale, 0); // from where the group begins
        toned(desk, Tone::faint, line.does);
    }
    ImGui::NewLine();
}

} // namespace

void drawKeySheet(PanelDesk& desk)
{
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowBgAlpha(0.98F); // it is read, not looked through
    ImGui::SetNextWindowPos(ImVec2(screen.x / 2, screen.y / 2), ImGuiCond_Always, ImVec2(0.5F, 0.5F));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(screen.x, screen.y));
    if (ImGui::Begin("Keys", &desk.state.keys,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove)) {
        const float column = 330 * desk.scale;
        ImGui::BeginGroup();
        drawLines(desk, "look", kPointer);
        drawLines(desk, "show", kShown);
        ImGui::EndGroup();
        ImGui::SameLine(column);
        ImGui::BeginGroup();
        drawLines(desk, "touch and paint", kTouch);
        drawLines(desk, "program", kProgram);
        ImGui::EndGroup();
    }
    ImGui::End();
}

} // namespace palp
