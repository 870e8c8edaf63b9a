#include <imgui.h>

#include "engine/core/quantity.h"
#include "engine/tools/gui/panel_parts.h"

namespace palp {
namespace {

/// Draws a slider of a number in SI units that is shown in other units.
void slider(const PanelDesk& desk, const char* label, const char* means, double& value, double perUnit, double least,
            double most, const char* format, bool logarithmic)
{
    labelled(desk, label, means);
    double shown = value / perUnit;
    ImGui::PushID(label);
    if (ImGui::SliderScalar("##slider", ImGuiDataType_Double, &shown, &least, &most, format,
                            ImGuiSliderFlags_AlwaysClamp |
                                (logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None)))
        value = shown * perUnit;
    ImGui::PopID();
}

} // namespace

void drawPaintSection(PanelDesk& desk)
{
    BrushChoice& brush = desk.state.brush;
    if (const auto how = segments(desk, "how", brush.smooths ? 1 : 0, {"paint", "smooth"})) brush.smooths = *how == 1;
    slider(desk, "radius  [ ]", "Radius of the brush; [ and ] change it", brush.radius, 1e-3,
           1e3 * BrushChoice::kSmallest, 1e3 * BrushChoice::kLargest, "%.1f mm", true);
    ImGui::BeginDisabled(brush.smooths);
    // Without a number in its format, a slider does not round: a stiffness has three digits in whichever unit.
    if (desk.content.cloud.kind() == StiffnessKind::modulus)
        slider(desk, "stiffness", "Young's modulus that is painted", brush.value, 1, 1e3, 1e8,
               formatQuantity(brush.value, "Pa").c_str(), true);
    else
        slider(desk, "rigidity", "Flexural rigidity that is painted", brush.value, 1, 1e-6, 10,
               formatQuantity(brush.value, "N m").c_str(), true);
    ImGui::EndDisabled();
    slider(desk, "strength", "Share of the way to the painted value that one stroke goes", brush.strength, 1e-2, 1, 100,
           "%.0f %%", false);
    desk.wishes.undo |= buttonIf(desk.content.canUndo, "undo  Ctrl+Z", "Undoes the last stroke");
    ImGui::SameLine();
    desk.wishes.redo |= buttonIf(desk.content.canRedo, "redo  Ctrl+Y", "Paints the stroke again");
    desk.wishes.save |= buttonIf(desk.content.painted, "save  Ctrl+S", "Writes the cloud as PLY");
    ImGui::SameLine();
    toned(desk, desk.content.painted ? Tone::warning : Tone::faint, desk.content.painted ? "not saved" : "unchanged");
}

} // namespace palp
