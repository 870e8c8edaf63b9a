#pragma once
#include <chrono>

#include "engine/tools/gui/panel_frame.h"
#include "engine/tools/gui/panels.h"
#include "engine/tools/gui/screen.h"

namespace palp {

/// Draws the panels when they are due: at once while the user works in them, otherwise a few times a second, because
/// drawing them takes as long as drawing the object. Invariant: each frame of ImGui that is begun is ended.
/// \thread the window's
class PanelLayer {
public:
    /// \param frame  outlives this; null: there are no panels
    explicit PanelLayer(PanelFrame* frame) : frame_(frame) {}

    [[nodiscard]] bool exist() const noexcept { return frame_ != nullptr; }

    /// Gives the panels the input.
    /// \return the input, marked with what the panels take
    [[nodiscard]] WindowInput begin(WindowInput input, bool dark, bool resized);
    /// Draws the panels if they are due.
    /// \return what the user asked for in them
    [[nodiscard]] PanelWishes draw(ViewState& state, const PanelContent& content, double scale, Screen& screen);
    /// Draws nothing; the last panels stay.
    void skip();

    [[nodiscard]] bool due() const { return due_; }

private:
    PanelFrame*                           frame_;
    bool                                  due_         = false;                    ///< a frame of ImGui has begun
    bool                                  takePointer_ = false, takeKeys_ = false; ///< as of the last frame
    bool                                  leftBefore_ = false;                     ///< the left button was down
    std::chrono::steady_clock::time_point drawnAt_{};
};

} // namespace palp
