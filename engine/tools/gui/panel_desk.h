#pragma once
#include "engine/tools/gui/panels.h"

// Internal to the panels of engine/tools/gui, in builds with Dear ImGui.

namespace palp {

/// The inputs of every section of the panels, for one frame.
struct PanelDesk {
    ViewState&          state;
    const PanelContent& content;
    PanelWishes&        wishes;
    float               scale; ///< pixels per unit of length of the layout [1]

    [[nodiscard]] bool dark() const { return state.look.ground == Ground::dark; }
};

/// Draws one bar over the whole width.
/// \return its height [px]
float drawStatusLine(PanelDesk& desk);

// The sections of the column, without their headers.
void drawViewSection(PanelDesk& desk);
void drawTouchSection(PanelDesk& desk);
void drawChartSection(PanelDesk& desk);
void drawTimingSection(PanelDesk& desk);
void drawSceneSection(PanelDesk& desk);
void drawPaintSection(PanelDesk& desk);

/// Draws all keys over the middle of the picture, until the sheet is closed.
void drawKeySheet(PanelDesk& desk);

} // namespace palp
