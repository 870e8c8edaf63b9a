#include "engine/tools/gui/panel_layer.h"

#include <utility>

namespace palp {

WindowInput PanelLayer::begin(WindowInput input, bool dark, bool resized)
{
    constexpr auto kSeldom = std::chrono::milliseconds(200);
    const auto     now     = std::chrono::steady_clock::now();
    const bool     glides  = input.moved != glm::dvec2(0) && !input.touch;
    const bool     presses = input.left || input.leftPressed || leftBefore_ || !input.keys.empty();
    // What a press takes is known only from a frame of ImGui: the pointer may have come onto a panel with it.
    const bool orbits  = !takePointer_ && input.left && leftBefore_ && !input.leftPressed;
    const bool scrolls = takePointer_ && input.wheel != 0;
    due_               = frame_ &&
           (((glides || presses) && !orbits) || scrolls || !input.typed.empty() || resized || now - drawnAt_ > kSeldom);
    leftBefore_ = input.left;
    if (!due_) {
        input.panelsTakePointer = takePointer_;
        input.panelsTakeKeys    = takeKeys_;
        return input;
    }
    drawnAt_ = now;
    frame_->setDark(dark);
    input        = frame_->begin(std::move(input));
    takePointer_ = input.panelsTakePointer;
    takeKeys_    = input.panelsTakeKeys;
    return input;
}

PanelWishes PanelLayer::draw(ViewState& state, const PanelContent& content, double scale, Screen& screen)
{
    if (!std::exchange(due_, false)) return {};
    PanelWishes wishes = drawPanels(state, content, scale);
    frame_->end();
    screen.takePanels();
    return wishes;
}

void PanelLayer::skip()
{
    if (std::exchange(due_, false)) frame_->end();
}

} // namespace palp
