#pragma once
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>

#include "engine/tools/gui/panel_parts.h"
#include "engine/tools/plot/axis.h"

// Internal to the panels of engine/tools/gui, in builds with Dear ImGui.

namespace palp {

/// What a small plot shows; numbers are in the units of its titles.
struct PanelPlotSettings {
    const char* title;  ///< with the unit: "force [N]"
    ValueRange  x, y;   ///< of the axes
    const char* xUnit;  ///< beside the last number below: "s"
    float       height; ///< without the numbers below, at scale 1 [px]
    Scale       xScale   = Scale::linear;
    bool        yNumbers = true;  ///< numbers beside the axis; without them heights compare only
    bool        yDown    = false; ///< larger values are lower, as depths are
};

/// A plot of the panels' width: the frame, round ticks and titles at once, curves as they are added.
class PanelPlot {
public:
    PanelPlot(const PanelDesk& desk, const PanelPlotSettings& settings);

    enum class Stroke { whole, dashed };
    /// Values at even steps. \param first, step  along x, in its unit
    void curve(std::span<const float> values, double first, double step, Tone tone, Stroke stroke = Stroke::whole);

    /// Bars side by side over the whole of x; heights in the unit of y, zero for none.
    void bars(std::span<const float> heights, Tone tone);

    /// An upright line at a value of x, below the title.
    void mark(double x, Tone tone);

    /// In the upper right corner, from right to left: a stroke and what it means.
    void legend(const char* text, Tone tone, Stroke stroke = Stroke::whole);

    /// Where the pointer is, in units of the axes; empty if it is elsewhere.
    [[nodiscard]] std::optional<glm::dvec2> pointed() const;

private:
    void                    drawFrame(const PanelPlotSettings& settings) const;
    void                    line(const glm::vec2& from, const glm::vec2& to, Tone tone, Stroke stroke) const;
    [[nodiscard]] glm::vec2 pixel(double x, double y) const;

    const PanelDesk& desk_;
    Axis             x_, y_;
    glm::vec2        low_{}, high_{}; // upper left and lower right corner of the frame [px]
    bool             down_;
    float            legendEnd_ = 0; // where the next legend ends [px]
    bool             pointed_   = false;
};

/// The least of 1, 2, 3 and 5 times a power of ten that is no less than a value: the end of an axis that seldom moves.
/// \param least  what the end never falls below, and is if the value cannot be drawn; > 0
[[nodiscard]] double roundEnd(double value, double least);

} // namespace palp
