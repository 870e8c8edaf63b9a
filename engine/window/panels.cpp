#include "engine/window/panels.h"

#include <imgui.h>

namespace palp {

PanelWishes drawPanels(ViewState& state, const PanelContent& content, double scale)
{
    PanelWishes wishes;
    static_cast<void>(state);
    static_cast<void>(content);
    static_cast<void>(scale);
    return wishes;
}

} // namespace palp
