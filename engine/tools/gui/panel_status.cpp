#include <algorithm>

#include <imgui.h>

#include "engine/tools/gui/panel_layout.h"
#include "engine/tools/gui/panel_parts.h"
#include "engine/tools/gui/touch_faults.h"

namespace palp {
namespace {

void drawBadges(const PanelDesk& desk)
{
    const PanelContent& content = desk.content;
    const auto          show    = [](const char* text, Rgb8 fill) {
        ImGui::SameLine();
        badge(text, fill);
    };
    if (content.touching && !content.replaying) show("touching", kNamedColours[0]);
    if (content.replaying) show("replaying", kNamedColours[2]);
    if (!content.recording.empty()) {
        show("recording", kNamedColours[1]);
        tip(("Into " + content.recording + "; F5 ends it").c_str());
    }
    if (desk.state.tool == Tool::paint) show("paint", kNamedColours[3]);
    if (needsAttention(content)) {
        const GovernorFault fault = governorFault(content.history.newest());
        const bool          isOff = fault != GovernorFault::none;
        if (hasColumn(desk.state)) {
            show("fault: see Touch", colourOf(Tone::fault, false));
            tip(isOff ? adviceOn(fault).reason : content.faults.back().c_str());
        } else { // nothing else says it
            show(isOff ? "no force, R starts anew" : "fault", colourOf(Tone::fault, false));
            ImGui::SameLine();
            const std::string why =
                isOff ? std::string(adviceOn(fault).remedy) + " " + adviceOn(fault).reason : content.faults.back();
            ImGui::TextUnformatted(why.c_str());
            tip(why.c_str());
        }
    }
}

} // namespace

float drawStatusLine(PanelDesk& desk)
{
    const float  pad = kStatusPad * desk.scale, high = statusHeight(desk.scale);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(screen.x, high));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10 * desk.scale, pad));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    if (ImGui::Begin("status", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
        ImGui::TextUnformatted(desk.content.title.c_str());
        if (!desk.content.hand.empty()) {
            ImGui::SameLine();
            toned(desk, Tone::faint, "\u00b7  " + desk.content.hand);
        }
        drawBadges(desk);
        ImGui::SameLine();
        const std::string& message = desk.content.message;
        const float        wide    = ImGui::CalcTextSize(message.c_str()).x;
        ImGui::SameLine(std::max(ImGui::GetCursorPosX() + pad, ImGui::GetWindowContentRegionMax().x - wide));
        ImGui::TextUnformatted(message.c_str());
        if (!message.empty()) tip(message.c_str()); // a long one ends beyond the window
        if (message.empty()) {
            constexpr const char* kHint = "F1 keys";
            ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(kHint).x);
            toned(desk, Tone::faint, kHint);
        }
    }
    ImGui::End();
    ImGui::PopStyleVar(3);
    return high;
}

} // namespace palp
