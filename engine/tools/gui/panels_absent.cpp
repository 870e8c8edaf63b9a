#include "engine/tools/gui/panel_frame.h"
#include "engine/tools/gui/panels.h"

// Builds without Dear ImGui have no panels.

namespace palp {

bool PanelFrame::available() noexcept
{
    return false;
}

PanelFrame::PanelFrame(double scale) : scale_(scale) {}
PanelFrame::~PanelFrame() = default;

void PanelFrame::setDark(bool dark)
{
    dark_ = dark;
}

void PanelFrame::setScale(double scale)
{
    scale_ = scale;
}

void PanelFrame::beginWithoutWindow(const glm::ivec2&, const PanelPointer&) {}

WindowInput PanelFrame::begin(WindowInput input)
{
    last_ = {};
    return input;
}

void PanelFrame::end() {}

PanelWishes drawPanels(ViewState&, const PanelContent&, double)
{
    return {};
}

} // namespace palp
