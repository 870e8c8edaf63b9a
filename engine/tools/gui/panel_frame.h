#pragma once
#include <chrono>

#include <glm/vec2.hpp>

#include "engine/tools/gui/input.h"

namespace palp {

/// Pointer and button for ImGui where there is no window, as in pictures without a display.
struct PanelPointer {
    glm::dvec2 at{-1, -1}; ///< [px]
    bool       down = false;
};

/// The one ImGui context of a program: its font, its style, the beginning and the end of its frames.
/// \thread one
class PanelFrame {
public:
    /// Returns whether this build has panels; without them all functions do nothing.
    [[nodiscard]] static bool available() noexcept;

    /// \param scale  of a display with many pixels per inch [1]
    explicit PanelFrame(double scale = 1);
    ~PanelFrame();
    PanelFrame(const PanelFrame&)            = delete;
    PanelFrame& operator=(const PanelFrame&) = delete;

    /// Sets a light or dark style, to match the ground.
    void setDark(bool dark);

    /// Sets font and distances for another display; does nothing if the scale is the same.
    /// \pre between two frames
    void setScale(double scale);

    /// Begins a frame without a window.
    /// \param size  of the picture [px]
    void beginWithoutWindow(const glm::ivec2& size, const PanelPointer& pointer = {});

    /// Begins a frame with a window's input, at its scale.
    /// \return the input, marked with what the panels take
    [[nodiscard]] WindowInput begin(WindowInput input);

    void end();

private:
    double                                scale_ = 0; ///< [1]; 0: not set yet
    bool                                  dark_  = false;
    std::chrono::steady_clock::time_point last_{}; ///< time of the last frame with a window
};

} // namespace palp
