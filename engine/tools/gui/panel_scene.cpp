#include <cstring>
#include <vector>

#include <imgui.h>

#include "engine/tools/gui/panel_parts.h"
#include "engine/tools/gui/scene_controls.h"

namespace palp {
namespace {

constexpr float kLabels   = 118; ///< width of this section's labels, at scale 1 [px]
constexpr float kOwnWidth = 44;  ///< of the button beside a law, at scale 1 [px]

/// Returns a key's meaning, the values it takes, and the source of its value.
void explain(const PanelDesk& desk, std::string_view name)
{
    if (!ImGui::IsItemHovered()) return;
    const SceneKey& key  = sceneKey(name);
    std::string     text = std::string(name) + ": " + std::string(key.help) + "\nexpected: " + key.expected();
    if (const auto from = desk.content.scene.origins.find(name); from != desk.content.scene.origins.end())
        text += std::string("\nnow from: ") + palp::name(from->second.origin) +
                (from->second.where.empty() ? "" : ", " + from->second.where);
    tip(text.c_str());
}

void labelOf(const PanelDesk& desk, const char* label, std::string_view key)
{
    ImGui::AlignTextToFramePadding();
    toned(desk, Tone::faint, label);
    explain(desk, key);
    ImGui::SameLine(kLabels * desk.scale + ImGui::GetStyle().WindowPadding.x, 0);
    ImGui::SetNextItemWidth(-1);
}

/// Draws a slider that shows the scene's value except while it is dragged, and makes a wish when it is released.
void drawSlider(PanelDesk& desk, const SceneKey& key)
{
    const KeyControl& control = *key.control;
    ImGui::PushID(key.name.data(), key.name.data() + key.name.size());
    labelOf(desk, control.label, key.name);
    ImGuiStorage* const kept  = ImGui::GetStateStorage();
    const ImGuiID       value = ImGui::GetID("dragged"), isDragged = ImGui::GetID("is dragged");
    const double        now    = key.number(desk.content.scene) / control.perUnit;
    double              shown  = kept->GetBool(isDragged) ? double(kept->GetFloat(value)) : now;
    const std::string   format = formatted("%%.%df%s%s", control.decimals, *control.unit ? " " : "", control.unit);
    ImGui::SliderScalar("##slider", ImGuiDataType_Double, &shown, &control.least, &control.most, format.c_str(),
                        control.logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    explain(desk, key.name);
    if (ImGui::IsItemDeactivatedAfterEdit() && wishText(key, shown) != wishText(key, now))
        desk.wishes.values[std::string(key.name)] = wishText(key, shown);
    kept->SetFloat(value, float(shown));
    kept->SetBool(isDragged, ImGui::IsItemActive());
    ImGui::PopID();
}

void drawList(PanelDesk& desk, const SceneKey& key)
{
    ImGui::PushID(key.name.data(), key.name.data() + key.name.size());
    labelOf(desk, key.control->label, key.name);
    const std::string now  = optionNow(key, desk.content.scene);
    const bool        open = ImGui::BeginCombo("##combo", now.c_str());
    if (!open) explain(desk, key.name);
    if (open) {
        for (const std::string& option : optionsOf(key))
            if (ImGui::Selectable(option.c_str(), now == option) && now != option)
                desk.wishes.values[std::string(key.name)] = option;
        ImGui::EndCombo();
    }
    ImGui::PopID();
}

void drawLaw(PanelDesk& desk)
{
    constexpr std::size_t kRoom = 1024;  // [bytes] for typed text
    constexpr const char* kOwn  = "own"; // the key's word for no law
    const std::string&    now   = desk.content.scene.stiffness;
    std::vector<char>     text(now.size() + kRoom);
    std::memcpy(text.data(), now.c_str(), now.size() + 1);
    ImGui::AlignTextToFramePadding();
    toned(desk, Tone::faint, "stiffness");
    explain(desk, "stiffness");
    ImGui::SameLine(kLabels * desk.scale + ImGui::GetStyle().WindowPadding.x, 0);
    ImGui::SetNextItemWidth(now.empty() ? -1 : -kOwnWidth * desk.scale);
    if (ImGui::InputTextWithHint("##law", "the cloud's own", text.data(), text.size(),
                                 ImGuiInputTextFlags_EnterReturnsTrue) &&
        now != text.data())
        desk.wishes.values["stiffness"] = *text.data() ? text.data() : kOwn;
    explain(desk, "stiffness");
    if (!now.empty()) { // the button that restores the cloud's own
        ImGui::SameLine();
        if (ImGui::SmallButton(kOwn)) desk.wishes.values["stiffness"] = kOwn;
        tip("Restores the cloud's own stiffness");
    }
    bool first = true;
    for (const char* law : {"constant", "linear", "hyperbolic", "gaussian"}) {
        if (!first) ImGui::SameLine();
        first = false;
        if (ImGui::SmallButton(law))
            desk.wishes.values["stiffness"] = lawPreset(law, desk.content.scene, desk.content.cloud);
        tip("Applies this law, from the least to the largest stiffness of the cloud");
    }
}

/// Draws two opposite sides of the patch window in one line.
void drawSides(PanelDesk& desk, const char* label, Edge PlateEdges::*low, Edge PlateEdges::*high)
{
    labelOf(desk, label, "edges");
    const PlateEdges now   = desk.content.scene.patch.edges;
    const float      width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemInnerSpacing.x) / 2;
    for (Edge PlateEdges::*const side : {low, high}) {
        ImGui::PushID(label);
        ImGui::PushID(side == low ? 0 : 1);
        if (side == high) ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
        ImGui::SetNextItemWidth(width);
        const bool open = ImGui::BeginCombo("##side", name(now.*side), ImGuiComboFlags_NoArrowButton);
        if (!open) explain(desk, "edges");
        for (const auto& [edge, word] : namesOf(Edge{})) {
            if (!open || !ImGui::Selectable(word, edge == now.*side) || edge == now.*side) continue;
            PlateEdges changed          = now;
            changed.*side               = edge;
            desk.wishes.values["edges"] = edgesText(changed);
        }
        if (open) ImGui::EndCombo();
        ImGui::PopID();
        ImGui::PopID();
    }
}

} // namespace

void drawSceneSection(PanelDesk& desk)
{
    drawLaw(desk);
    for (const SceneControls& group : sceneControls()) {
        ImGui::Separator();
        for (const SceneKey* key : group.sliders) drawSlider(desk, *key);
        for (const SceneKey* key : group.lists) drawList(desk, *key);
        if (!group.edges) continue;
        drawSides(desk, "edges x0, x1", &PlateEdges::x0, &PlateEdges::x1);
        drawSides(desk, "edges z0, z1", &PlateEdges::z0, &PlateEdges::z1);
    }
}

} // namespace palp
