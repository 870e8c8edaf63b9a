#pragma once
#include <memory>
#include <string>

#include "engine/tools/gui/input.h"
#include "engine/tools/render/surface_renderer.h"

namespace palp {

/// A window on the desktop.
/// \thread the program's first
class GlfwWindow {
public:
    /// \param size  size of the window [px]
    /// \throws Error if there is no display; the sentence adds that palpate render needs none
    GlfwWindow(const std::string& title, const glm::ivec2& size);
    ~GlfwWindow();
    GlfwWindow(const GlfwWindow&)            = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;

    /// Returns the link for the renderer that shows pictures here; the window outlives it.
    [[nodiscard]] WindowLink link();

    /// Returns what happened since the last call.
    /// \param patience  longest wait for something to happen [s]
    [[nodiscard]] WindowInput poll(double patience = 0);

    void setTitle(const std::string& title);

    /// Returns false once the display has gone, as when its server ends: the window is closing then, and shows nothing.
    [[nodiscard]] bool hasDisplay() const noexcept;

    [[nodiscard]] double scale() const; ///< see WindowInput::scale

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
