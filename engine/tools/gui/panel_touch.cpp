#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <imgui.h>

#include "engine/core/quantity.h"
#include "engine/session/force_state.h"
#include "engine/session/servo.h"
#include "engine/tools/gui/panel_plot.h"
#include "engine/tools/gui/touch_faults.h"

namespace palp {
namespace {

constexpr double kSpan     = TouchHistory::kSteps * TouchHistory::kStep; ///< of the curves over time [s]
constexpr double kHeadroom = 1.35; ///< factor above a curve, which leaves room for its title [1]

void drawFaults(PanelDesk& desk)
{
    const GovernorFault fault = governorFault(desk.content.history.newest());
    if (fault != GovernorFault::none) {
        badge("no force", colourOf(Tone::fault, false));
        ImGui::SameLine();
        toned(desk, Tone::fault, name(fault));
        tonedWrapped(desk, Tone::fault, adviceOn(fault).reason);
        tonedWrapped(desk, Tone::plain, adviceOn(fault).remedy);
    }
    for (const std::string& sentence : desk.content.faults) tonedWrapped(desk, Tone::fault, sentence);
    if (needsAttention(desk.content)) {
        if (ImGui::SmallButton("start anew")) desk.wishes.resetFault = true;
        tip("Clears these messages and begins a new session (R)");
    }
    const TickRecord& newest = desk.content.history.newest();
    if (!desk.content.touching && forceState(newest) != ForceState::deviceFaulty) return;
    for (const std::string& sentence : notesOn(newest, desk.content.deviceWords))
        tonedWrapped(desk, Tone::warning, sentence);
}

/// Returns the depth of the hand below the proxy [m]; 0 out of contact.
double penetration(const TickRecord& record)
{
    return std::max(0.0, glm::dot(record.proxy - record.hip, record.normal));
}

/// Names the theory in force and, of a shell, the length over which its dents die away.
void drawTheory(const PanelDesk& desk, const Patch& patch)
{
    if (!patch.curvature) {
        reading(desk, "theory", "plate", Tone::warning);
        return tip(patch.flatBecause.c_str());
    }
    reading(desk, "theory",
            formatted("shell, l %.1f mm, window %.1f l", patch.shellLength * 1e3,
                      patch.window.grid.sizeX() / patch.shellLength));
    tip("l is the length over which a dent of the shell dies away");
}

void drawNumbers(const PanelDesk& desk)
{
    constexpr double   kMostLess = 0.9; // of the object's: the contact is that of the patch's middle [1]
    const TickRecord&  now       = desk.content.history.newest();
    const bool         held      = desk.content.touching && now.normal != glm::dvec3(0);
    const Patch* const patch     = desk.content.patch;
    const auto         orDash    = [held](const std::string& text) { return held ? text : "\u2013"; };
    const double       kc        = patch ? patch->contactStiffness : 0;
    const bool         known     = held && now.compliance > 0 && kc > 0;
    const double       felt      = known ? feltStiffness(desk.content.scene.patch.forceLaw, kc, now.compliance) : 0;
    const bool         steady  = desk.content.scene.material.isLinear() && desk.content.scene.patch.large == Large::off;
    const bool         limited = known && steady && now.stiffness < kMostLess * felt;
    reading(desk, Half::left, "force", desk.content.touching ? formatted("%.2f N", glm::length(now.force)) : "\u2013");
    reading(desk, Half::right, "depth", orDash(formatted("%.2f mm", penetration(now) * 1e3)));
    reading(desk, Half::left, "felt",
            !known ? "\u2013" : formatQuantity(now.stiffness, "N/m") + (limited ? " cap" : ""));
    if (limited)
        tip(("The object's is " + formatQuantity(felt, "N/m") +
             ". The scene's stiffness_cap, the device, a slow loop or the energy tank holds it back")
                .c_str());
    reading(desk, Half::right, "rigidity", orDash(formatQuantity(now.rigidity, "N m")));
    reading(desk, Half::left, "dent", orDash(formatted("%.3f mm", now.maxDeflection * 1e3)));
    readingOfAge(desk, Half::right, "patch");
    if (patch && desk.content.scene.patch.theory == Theory::shell) drawTheory(desk, *patch);
}

void drawOverTime(const PanelDesk& desk)
{
    const TouchHistory& history = desk.content.history;
    std::vector<float>  depths(history.depths().begin(), history.depths().end());
    for (float& depth : depths) depth *= 1e3F; // [mm]
    const auto most = [](std::span<const float> values) {
        return values.empty() ? 0 : double(*std::ranges::max_element(values));
    };
    const double first = -double(depths.size() - (depths.empty() ? 0 : 1)) * TouchHistory::kStep; // [s]
    const auto   over  = [&](const char* title, std::span<const float> values, double least, Tone tone) {
        PanelPlot plot(desk, {title, {-kSpan, 0}, {0, roundEnd(kHeadroom * most(values), least)}, "s", 54});
        plot.curve(values, first, TouchHistory::kStep, tone);
        const auto at = plot.pointed();
        if (!at || values.empty()) return;
        const auto n =
            std::size_t(std::clamp(std::round((at->x - first) / TouchHistory::kStep), 0.0, double(values.size() - 1)));
        tip(formatted("%.2f s: %.3f", first + double(n) * TouchHistory::kStep, double(values[n])).c_str());
    };
    over("force [N]", history.forces(), 0.05, Tone::accent);
    over("penetration [mm]", depths, 0.1, Tone::second);
}

/// Returns the dent through the contact, along x or along z [mm].
std::vector<float> profile(const Patch& patch, double force, bool alongX)
{
    const PlateGrid&   grid    = patch.window.grid;
    const GridNode     contact = nodeAtContact(patch);
    std::vector<float> w;
    const int          nodes = alongX ? grid.nodesX() : grid.nodesZ();
    for (int n = 0; n < nodes; ++n)
        w.push_back(float(1e3 * force * (alongX ? patch.response(n, contact.j) : patch.response(contact.i, n))));
    return w;
}

void drawProfile(const PanelDesk& desk)
{
    const Patch* const patch = desk.content.patch;
    if (!patch || !patch->deformed()) {
        tonedWrapped(desk, Tone::faint, "No patch yet: hold Space and point at the object.");
        return;
    }
    const PatchWindow& window  = patch->window;
    const ChartPoint   pressed = pressedPlace(*patch);
    const ChartPoint   corner{window.corner.x - pressed.x, window.corner.z - pressed.z}; // from the contact [m]
    const auto         x = profile(*patch, desk.content.force, true), z = profile(*patch, desk.content.force, false);
    const double       deepest = double(std::max(*std::ranges::max_element(x), *std::ranges::max_element(z)));
    const double       least   = desk.content.force > 0 ? 0.02 : 0.2; // [mm] smaller ends leave no room for labels
    const double       end     = roundEnd(deepest, least);
    const ValueRange   across{1e3 * std::min(corner.x, corner.z),
                            1e3 * std::max(corner.x + window.grid.sizeX(), corner.z + window.grid.sizeZ())}; // [mm]
    // Depths point down, as in the object; beyond zero there is room for the title.
    PanelPlot plot(desk, {"dent w [mm]", across, {-0.4 * end, end}, "mm", 76, Scale::linear, true, true});
    plot.legend("z", Tone::second, PanelPlot::Stroke::dashed);
    plot.legend("x", Tone::accent);
    plot.curve(z, 1e3 * corner.z, 1e3 * window.grid.spacingZ, Tone::second, PanelPlot::Stroke::dashed);
    plot.curve(x, 1e3 * corner.x, 1e3 * window.grid.spacingX, Tone::accent);
    const auto at = plot.pointed();
    if (!at) return;
    const auto n = std::size_t(
        std::clamp(std::round((at->x * 1e-3 - corner.x) / window.grid.spacingX), 0.0, double(x.size() - 1)));
    tip(formatted("x = %.1f mm: %.4f mm", 1e3 * (corner.x + double(n) * window.grid.spacingX), double(x[n])).c_str());
}

} // namespace

void drawTouchSection(PanelDesk& desk)
{
    drawFaults(desk);
    drawNumbers(desk);
    drawOverTime(desk);
    drawProfile(desk);
}

} // namespace palp
