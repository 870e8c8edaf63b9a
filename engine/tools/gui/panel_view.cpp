#include <imgui.h>

#include "engine/tools/gui/panel_parts.h"

namespace palp {
namespace {

constexpr double kDeepest = 3; ///< of the hand below the surface, and its highest above it, per thickness [1]

void drawColours(PanelDesk& desk)
{
    TouchLook& look = desk.state.look;
    labelled(desk, "colours", "What the colours of the surface show (V)");
    if (const auto paint = segments(desk, "paint", int(look.paint), {"deflection", "stiffness", "plain"}))
        look.paint = ViewPaint(*paint);
    labelled(desk, "colour map", "viridis and cividis keep their order for every kind of colour vision (C)");
    if (const auto map = segments(desk, "map", int(look.map), {"viridis", "cividis", "grey"}))
        look.map = ColourMap(*map);
}

/// Draws the list of objects that can be opened.
void drawObjects(PanelDesk& desk)
{
    if (desk.content.offered.empty()) return;
    labelled(desk, "object");
    const bool open = ImGui::BeginCombo("##object", desk.content.title.c_str(), ImGuiComboFlags_HeightLarge);
    if (!open) return tip("Opens a sample, or a file that was opened before; files can also be dropped on the window");
    for (const std::string& what : desk.content.offered)
        if (ImGui::Selectable(what.c_str())) desk.wishes.open = what;
    ImGui::EndCombo();
}

void drawToggles(PanelDesk& desk)
{
    TouchLook&  look   = desk.state.look;
    Overlays&   over   = look.overlays;
    const float middle = ImGui::GetCursorPosX() + 0.46F * ImGui::GetContentRegionAvail().x;
    const auto  second = [middle] { ImGui::SameLine(middle); };
    ImGui::Checkbox("patch outline", &over.outline);
    second();
    ImGui::Checkbox("surface at rest", &over.ghost);
    tip("Dots where the dent's points are at rest (G)");
    ImGui::Checkbox("arrows", &over.arrows);
    tip("Force on the hand, and normal");
    second();
    ImGui::Checkbox("fitted sphere", &over.sphere);
    tip("The near half of the sphere fitted to the patch (S)");
    ImGui::Checkbox("markers", &over.markers);
    tip("Proxy, a ball, and HIP, an octahedron");
    second();
    ImGui::Checkbox("projected points", &over.projected);
    tip("Dots where the patch's points lie on the sphere (J)");
    bool dark = desk.dark(), flat = desk.state.camera.projection == Projection::orthographic;
    if (ImGui::Checkbox("dark", &dark)) look.ground = dark ? Ground::dark : Ground::light;
    tip("L");
    second();
    if (ImGui::Checkbox("orthographic", &flat)) desk.state.camera = otherProjection(desk.state.camera);
    tip("O");
    if (desk.content.scene.patch.theory == Theory::shell) {
        ImGui::Checkbox("curvature", &over.curvature);
        tip("Crosses along the principal curvatures that the shell bent with (U)");
    }
}

void drawButtons(PanelDesk& desk)
{
    desk.wishes.frame |= buttonIf(true, "frame", "Fits the whole object into the picture (F)");
    ImGui::SameLine();
    desk.wishes.reset |= buttonIf(true, "reset", "Restores the first view (R)");
    ImGui::SameLine();
    desk.wishes.screenshot |=
        buttonIf(true, "screenshot", "Writes the picture to a file, without panels (P) or with them (Shift+P)");
    ImGui::SameLine();
    const bool recording = !desk.content.recording.empty();
    desk.wishes.record |= buttonIf(true, recording ? "stop##record" : "record##record",
                                   recording ? "Ends the recording (F5)" : "Records the session (F5)");
}

void drawTool(PanelDesk& desk)
{
    labelled(desk, "tool", "The pointer carries a hand that touches, or a brush of stiffness (B)");
    if (segments(desk, "tool", int(desk.state.tool), {"touch", "paint"})) desk.wishes.tool = true;
    labelled(desk, "press depth", "Depth of the pointer's hand below the surface; the wheel sets it while touching");
    const double most = 1e3 * kDeepest * desk.content.scene.material.thickness, least = -most; // [mm]
    double       depth = 1e3 * desk.state.pressDepth;                                          // [mm]
    if (ImGui::SliderScalar("##depth", ImGuiDataType_Double, &depth, &least, &most, "%.2f mm",
                            ImGuiSliderFlags_AlwaysClamp))
        desk.state.pressDepth = depth * 1e-3;
}

} // namespace

void drawViewSection(PanelDesk& desk)
{
    drawObjects(desk);
    drawColours(desk);
    labelled(desk, "exaggerate", "Factor on every displacement in the picture; forces do not change (X)");
    const double least = 1, most = 20;
    ImGui::SliderScalar("##exaggeration", ImGuiDataType_Double, &desk.state.look.exaggeration, &least, &most,
                        "\u00d7 %.1f", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    drawToggles(desk);
    drawButtons(desk);
    drawTool(desk);
}

} // namespace palp
