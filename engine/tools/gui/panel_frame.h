#pragma once
#include <chrono>

#include <glm/vec2.hpp>

#include "engine/tools/gui/input.h"

namespace palp {

/// Pointer and buttons where no window gives them to ImGui, as in pictures without a display.
struct PanelPointer {
    glm::dvec2 at{-1, -1}; ///< [px]
    bool       down = false;
};

/// The one ImGui context of a program: its font, its style, the beginning and the end of its frames. \thread one
class PanelFrame {
public:
    /// Returns whether this build has panels; without them nothing here does anything.
    [[nodiscard]] static bool available() noexcept;

    /// \param scale  of a display with many pixels per inch [1]
    explicit PanelFrame(double scale = 1);
    ~PanelFrame();
    PanelFrame(const PanelFrame&)            = delete;
    PanelFrame& operator=(const PanelFrame&) = delete;

    /// Light or dark, as the ground is.
    void setDark(bool dark);

    /// Another display: font and distances in its pixels from now on. The same as before: nothing.
    /// \pre between two frames
    void setScale(double scale);

    /// A frame without a window. \param size  of the picture [px]
    void beginWithoutWindow(const glm::ivec2& size, const PanelPointer& pointer = {});

    /// A frame with what happened in a window, at its scale. \return the same, with what the panels take for themselves
    [[nodiscard]] WindowInput begin(WindowInput input);

    void end();

private:
    double                                scale_ = 0; ///< [1]; 0: not set yet
    bool                                  dark_  = false;
    std::chrono::steady_clock::time_point last_{}; ///< frame of a window
};

} // namespace palp
