#include <algorithm>
#include <cmath>
#include <vector>

#include <imgui.h>

#include "engine/core/quantity.h"
#include "engine/session/servo.h"
#include "engine/tools/gui/panel_plot.h"

namespace palp {
namespace {

std::string orDash(bool known, const std::string& text)
{
    return known ? text : "\u2013";
}

/// Draws counts on a logarithmic scale, so that one late tick in a million is visible.
void drawPeriods(const PanelDesk& desk)
{
    const std::span<const float> counts = desk.content.history.periods();
    std::vector<float>           heights;
    for (const float count : counts) heights.push_back(std::log10(1 + count));
    const double most = std::max(1.0, double(*std::ranges::max_element(heights)));
    PanelPlot    plot(desk, {"ticks, log scale",
                             {1e3 * TouchHistory::kShortest, 1e3 * TouchHistory::kLongest},
                             {0, 1.6 * most},
                             "ms",
                             64,
                             Scale::logarithmic,
                             false});
    plot.bars(heights, Tone::accent);
    plot.mark(1, Tone::second); // [ms] the servo's intended period
    const auto at = plot.pointed();
    if (!at) return;
    const double share =
        std::log(at->x / (1e3 * TouchHistory::kShortest)) / std::log(TouchHistory::kLongest / TouchHistory::kShortest);
    const auto bin = std::size_t(std::clamp(share * double(counts.size()), 0.0, double(counts.size()) - 1));
    tip(formatted("%.2f ms: %.0f of %.0f ticks", at->x, double(counts[bin]), double(desk.content.history.ticks()))
            .c_str());
}

void drawPlate(const PanelDesk& desk)
{
    const PanelContent& content = desk.content;
    const Patch* const  patch   = content.patch;
    reading(desk, Half::left, "solve", orDash(content.solveTime > 0, formatted("%.1f ms", 1e3 * content.solveTime)));
    reading(desk, Half::right, "steps",
            patch && patch->report.iterations ? formatted("%d", *patch->report.iterations) : "\u2013");
    reading(desk, Half::left, "error",
            patch && patch->report.errorEstimate ? formatNumber(*patch->report.errorEstimate) : "\u2013");
    readingOfAge(desk, Half::right, "patch age");
}

void drawProcessor(const PanelDesk& desk, const char* role, const std::string& processor, bool software)
{
    ImGui::AlignTextToFramePadding();
    toned(desk, Tone::faint, role);
    ImGui::SameLine(66 * desk.scale + ImGui::GetStyle().WindowPadding.x, 0);
    if (software) {
        badge("software", colourOf(Tone::warning, false));
        tip("This machine draws without a GPU, which slows pictures but not forces");
        ImGui::SameLine();
    }
    ImGui::TextUnformatted(processor.empty() ? "\u2013" : processor.c_str()); // cut off at the panel's edge
    tip(processor.c_str());
}

} // namespace

void drawTimingSection(PanelDesk& desk)
{
    const PanelContent& content = desk.content;
    const bool          runs    = content.loopPeriod > 0;
    reading(desk, Half::left, "servo", orDash(runs, formatted("%.0f Hz", runs ? 1 / content.loopPeriod : 0)));
    reading(desk, Half::right, "period", orDash(runs, formatted("%.3f ms", 1e3 * content.loopPeriod)));
    if (!content.realTime.empty()) tonedWrapped(desk, Tone::warning, content.realTime);
    drawPeriods(desk);
    drawPlate(desk);
    const bool draws = content.frameTime > 0;
    reading(desk, Half::left, "frame", orDash(draws, formatted("%.1f ms", 1e3 * content.frameTime)));
    reading(desk, Half::right, "frames", orDash(draws, formatted("%.0f per s", draws ? 1 / content.frameTime : 0)));
    drawProcessor(desk, "plate on", content.solvedOn, false);
    if (!content.takeover.empty()) tonedWrapped(desk, Tone::warning, content.takeover);
    drawProcessor(desk, "drawn on", content.drawnOn, content.drawnInSoftware);
}

} // namespace palp
