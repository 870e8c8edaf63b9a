#pragma once
#include "engine/tools/gui/panels.h"

// Internal to the panels of engine/tools/gui, in builds with Dear ImGui.

namespace palp {

/// What every section of the panels works with, for one frame.
struct PanelDesk {
    ViewState&          state;
    const PanelContent& content;
    PanelWishes&        wishes;
    float               scale; ///< pixels per unit of length of the layout [1]

    [[nodiscard]] bool dark() const { return state.look.ground == Ground::dark; }
};

/// One bar over the whole width. \return its height [px]
float drawStatusLine(PanelDesk& desk);

// The sections of the column, without their headers.
void drawViewSection(PanelDesk& desk);
void drawTouchSection(PanelDesk& desk);
void drawChartSection(PanelDesk& desk);
void drawTimingSection(PanelDesk& desk);
void drawSceneSection(PanelDesk& desk);
void drawPaintSection(PanelDesk& desk);

/// All keys, over the middle of the picture, until it is closed.
void drawKeySheet(PanelDesk& desk);

} // namespace palp
