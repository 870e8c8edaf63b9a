#pragma once
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>

#include "engine/tools/gui/panel_parts.h"
#include "engine/tools/plot/axis.h"

// Internal to the panels of engine/tools/gui, in builds with Dear ImGui.

namespace palp {

/// The settings of a small plot; numbers are in the units of its titles.
struct PanelPlotSettings {
    const char* title;  ///< with the unit: "force [N]"
    ValueRange  x, y;   ///< of the axes
    const char* xUnit;  ///< written beside the last number below the plot: "s"
    float       height; ///< without the numbers below the plot, at scale 1 [px]
    Scale       xScale   = Scale::linear;
    bool        yNumbers = true;  ///< numbers beside the axis; without them heights can only be compared
    bool        yDown    = false; ///< larger values are lower, as depths are
};

/// A plot as wide as the panels. The frame, round ticks and titles are drawn at once, curves as they are added.
class PanelPlot {
public:
    PanelPlot(const PanelDesk& desk, const PanelPlotSettings& settings);

    enum class Stroke { whole, dashed };
    /// Draws values at even steps.
    /// \param first, step  along x, in its unit
    void curve(std::span<const float> values, double first, double step, Tone tone, Stroke stroke = Stroke::whole);

    /// Draws bars side by side over the whole of x, with heights in the unit of y, zero for none.
    void bars(std::span<const float> heights, Tone tone);

    /// Draws an upright line at a value of x, below the title.
    void mark(double x, Tone tone);

    /// Adds a stroke and its meaning in the upper right corner, from right to left.
    void legend(const char* text, Tone tone, Stroke stroke = Stroke::whole);

    /// Returns the pointer's place in units of the axes; empty if it is elsewhere.
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

/// Returns the least of 1, 2, 3 and 5 times a power of ten that is no less than a value: an axis end that seldom moves.
/// \param least  least end, and the end if the value cannot be drawn; > 0
[[nodiscard]] double roundEnd(double value, double least);

} // namespace palp
