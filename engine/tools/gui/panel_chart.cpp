#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <imgui.h>

#include "engine/core/quantity.h"
#include "engine/tools/gui/coarse_field.h"
#include "engine/tools/gui/panel_parts.h"
#include "engine/tools/plot/colour_map.h"

namespace palp {
namespace {

constexpr double kWide = 10; ///< a larger ratio of rigidities is shown on a logarithmic scale [1]

/// One of the two maps.
struct ChartMap {
    std::string title; ///< with the unit
    CoarseField coarse;
    Axis        axis;
};

Tone toneOf(Edge edge)
{
    return !holdsNodes(edge) ? Tone::second : holdsSlope(edge) ? Tone::plain : Tone::accent;
}

/// Draws clamped sides thick, supported ones thin, guided ones in thick dashes and free ones in thin ones, distinct
/// without their colours too.
void drawSide(const PanelDesk& desk, ImVec2 from, ImVec2 to, Edge edge)
{
    ImDrawList* const   draw = ImGui::GetWindowDrawList();
    const std::uint32_t ink  = packed(colourOf(toneOf(edge), desk.dark()));
    const float         s    = desk.scale;
    const float         wide = holdsSlope(edge) ? 4 * s : holdsNodes(edge) ? 1.5F * s : 2 * s;
    if (holdsNodes(edge)) return draw->AddLine(from, to, ink, wide);
    const float dash = 6 * s, length = std::hypot(to.x - from.x, to.y - from.y);
    const int   dashes = std::max(2, int(length / dash));
    for (int n = 0; n < dashes; ++n) {
        const auto at = [&](float share) {
            return ImVec2(from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share);
        };
        draw->AddLine(at(float(n) / float(dashes)), at((float(n) + 0.6F) / float(dashes)), ink, wide);
    }
}

/// Draws the field as a mesh whose corners have the colours of their values; z is up.
void drawField(const PanelDesk& desk, const ChartMap& map, ImVec2 corner, float side)
{
    ImDrawList* const   draw = ImGui::GetWindowDrawList();
    const int           nx = map.coarse.nodesX, nz = map.coarse.nodesZ;
    const ImVec2        white = ImGui::GetFontTexUvWhitePixel();
    const std::uint32_t none  = packed(kUndefinedColour);
    draw->PrimReserve(6 * (nx - 1) * (nz - 1), nx * nz);
    const unsigned first = draw->_VtxCurrentIdx;
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < nz; ++j) {
            const double value = map.coarse.at(i, j);
            draw->PrimWriteVtx(
                ImVec2(corner.x + side * float(i) / float(nx - 1), corner.y + side * (1 - float(j) / float(nz - 1))),
                white,
                drawable(value, map.axis.scale()) ? packed(surfaceColour(map.axis.position(value), desk.state.look.map))
                                                  : none);
        }
    for (int i = 0; i + 1 < nx; ++i)
        for (int j = 0; j + 1 < nz; ++j) {
            const unsigned a = first + unsigned(i * nz + j), b = a + unsigned(nz);
            for (const unsigned index : {a, b, b + 1, a, b + 1, a + 1}) draw->PrimWriteIdx(ImDrawIdx(index));
        }
}

/// Draws contact, fingertip and sides over a field.
void drawMarks(const PanelDesk& desk, const Patch& patch, ImVec2 corner, float side)
{
    ImDrawList* const draw = ImGui::GetWindowDrawList();
    const float       s    = desk.scale;
    const ImVec2      end(corner.x + side, corner.y + side);
    const PlateGrid&  grid = patch.window.grid;
    const ChartPoint  pressed = pressedPlace(patch);
    const ImVec2      contact(corner.x + side * float((pressed.x - patch.window.corner.x) / grid.sizeX()),
                              end.y - side * float((pressed.z - patch.window.corner.z) / grid.sizeZ()));
    // White on black is visible on every colour.
    for (const auto& [ink, thick] : {std::pair{IM_COL32(0, 0, 0, 200), 3 * s}, {IM_COL32(255, 255, 255, 255), s}}) {
        draw->AddLine(ImVec2(contact.x - 5 * s, contact.y), ImVec2(contact.x + 5 * s, contact.y), ink, thick);
        draw->AddLine(ImVec2(contact.x, contact.y - 5 * s), ImVec2(contact.x, contact.y + 5 * s), ink, thick);
    }
    const float fingertip = side * float(desk.content.scene.patch.footprintRadius / grid.sizeX());
    draw->AddCircle(contact, fingertip, IM_COL32(255, 255, 255, 150), 0, s);
    const PlateEdges& edges = patch.plate.edges;
    drawSide(desk, {corner.x, corner.y}, {corner.x, end.y}, edges.x0);
    drawSide(desk, {end.x, corner.y}, {end.x, end.y}, edges.x1);
    drawSide(desk, {corner.x, end.y}, {end.x, end.y}, edges.z0);
    drawSide(desk, {corner.x, corner.y}, {end.x, corner.y}, edges.z1);
}

void drawBar(const PanelDesk& desk, const ChartMap& map, ImVec2 corner, float side)
{
    ImDrawList* const   draw = ImGui::GetWindowDrawList();
    const float         s = desk.scale, high = 8 * s;
    const std::uint32_t text   = packed(colourOf(Tone::faint, desk.dark()));
    constexpr int       kSteps = 32;
    for (int n = 0; n < kSteps; ++n)
        draw->AddRectFilled(ImVec2(corner.x + side * float(n) / kSteps, corner.y),
                            ImVec2(corner.x + side * float(n + 1) / kSteps, corner.y + high),
                            packed(surfaceColour((n + 0.5) / kSteps, desk.state.look.map)));
    // Drawn from the right, as far as there is room.
    float free = corner.x + side + 1;
    for (auto tick = map.axis.ticks().rbegin(); tick != map.axis.ticks().rend(); ++tick) {
        const float at   = corner.x + side * float(map.axis.position(tick->value));
        const float wide = ImGui::CalcTextSize(tick->label.c_str()).x;
        const float left = std::clamp(at - wide / 2, corner.x, corner.x + side - wide);
        draw->AddLine(ImVec2(at, corner.y + high), ImVec2(at, corner.y + high + 3 * s), text);
        if (left + wide > free) continue;
        draw->AddText(ImVec2(left, corner.y + high + 3 * s), text, tick->label.c_str());
        free = left - 0.4F * ImGui::GetFontSize();
    }
}

/// \return the pointer's place on the map, in shares of its sides from the lower left corner
std::optional<ImVec2> drawMap(const PanelDesk& desk, const Patch& patch, const ChartMap& map, float side)
{
    ImGui::BeginGroup();
    ImGui::TextUnformatted(map.title.c_str());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton(map.title.c_str(), ImVec2(side, side));
    std::optional<ImVec2> pointed;
    if (const ImVec2 mouse = ImGui::GetMousePos(); ImGui::IsItemHovered())
        pointed = ImVec2((mouse.x - corner.x) / side, 1 - (mouse.y - corner.y) / side);
    drawField(desk, map, corner, side);
    drawMarks(desk, patch, corner, side);
    const ImVec2 bar(corner.x, corner.y + side + 5 * desk.scale);
    drawBar(desk, map, bar, side);
    ImGui::Dummy(ImVec2(side, 13 * desk.scale + ImGui::GetFontSize()));
    ImGui::EndGroup();
    return pointed;
}

/// Writes the values under the pointer, or else at the contact: the lines are always there, so that nothing jumps.
void drawReadOut(const PanelDesk& desk, const Patch& patch, const std::optional<ImVec2>& pointed)
{
    const PlateGrid& grid = patch.window.grid;
    const auto node = [](float share, int cells) { return std::clamp(int(share * float(cells) + 0.5F), 0, cells); };
    const int  i    = pointed ? node(pointed->x, grid.cellsX) : nodeAtContact(patch).i;
    const int  j    = pointed ? node(pointed->y, grid.cellsZ) : nodeAtContact(patch).j;
    toned(desk, Tone::faint, pointed ? "under the pointer" : "at the contact; point at a map to change it");
    reading(desk, Half::left, "x, right", formatted("%.1f mm", 1e3 * (patch.window.corner.x + i * grid.spacingX)));
    reading(desk, Half::right, "z, up", formatted("%.1f mm", 1e3 * (patch.window.corner.z + j * grid.spacingZ)));
    reading(desk, Half::left, "D", formatQuantity(patch.plate.rigidity(i, j), "N m"));
    reading(desk, Half::right, "w", formatted("%.4f mm", 1e3 * desk.content.force * patch.response(i, j)));
}

/// Explains how each kind of side that the patch has is drawn.
void drawKeyOfSides(const PanelDesk& desk, const PlateEdges& edges)
{
    const float mark = 16 * desk.scale, gap = 4 * desk.scale;
    bool        first = true;
    for (const auto& [edge, word] : namesOf(Edge{})) {
        if (edge != edges.x0 && edge != edges.x1 && edge != edges.z0 && edge != edges.z1) continue;
        if (!std::exchange(first, false)) ImGui::SameLine(0, 3 * gap);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float  y  = at.y + 0.55F * ImGui::GetFontSize();
        drawSide(desk, {at.x, y}, {at.x + mark, y}, edge);
        ImGui::Dummy(ImVec2(mark, ImGui::GetFontSize()));
        ImGui::SameLine(0, gap);
        toned(desk, Tone::faint, word);
    }
}

ChartMap rigidityMap(const Patch& patch)
{
    CoarseField coarse = coarseField(patch.plate.rigidity, 1);
    const auto  range  = rangeOf(coarse.values, Scale::logarithmic).value_or(ValueRange{1, 1});
    const Scale scale  = range.high > kWide * range.low ? Scale::logarithmic : Scale::linear;
    const Axis  axis(range, scale, "N m", 3);
    return {axis.title("D"), std::move(coarse), axis};
}

ChartMap dentMap(const Patch& patch, double force)
{
    constexpr double kFlat  = 0.01;                                     // [mm] smaller dents have the colour of none
    CoarseField      coarse = coarseField(patch.response, 1e3 * force); // [mm]
    const auto       range  = rangeOf(coarse.values, Scale::linear).value_or(ValueRange{0, 1});
    const Axis       axis({std::min(0.0, range.low), std::max(range.high, kFlat)}, Scale::linear, "", 3);
    return {axis.unit().empty() ? "w [mm]" : "w [" + axis.unit() + " mm]", std::move(coarse), axis};
}

} // namespace

void drawChartSection(PanelDesk& desk)
{
    const Patch* const patch = desk.content.patch;
    if (!patch || !patch->deformed()) {
        tonedWrapped(desk, Tone::faint, "Nothing is bent yet. Hold Space and point at the object to touch it.");
        return;
    }
    const float    gap  = 12 * desk.scale;
    const float    side = std::floor((ImGui::GetContentRegionAvail().x - gap) / 2);
    const ChartMap d = rigidityMap(*patch), w = dentMap(*patch, desk.content.force);
    auto           pointed = drawMap(desk, *patch, d, side);
    ImGui::SameLine(0, gap);
    if (const auto there = drawMap(desk, *patch, w, side)) pointed = there;
    drawKeyOfSides(desk, patch->plate.edges);
    drawReadOut(desk, *patch, pointed);
}

} // namespace palp
