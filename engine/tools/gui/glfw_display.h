#pragma once

namespace palp {

/// Sees to it that this program outlives its display. Xlib ends a program whose X server has gone, by exit() in the middle
/// of whatever its threads do; from now on it returns instead, and what it returns then means nothing. Call it after
/// GLFW's start. It does nothing on other desktops, whose windows are closed by GLFW, and with libX11 before 1.7.
/// \thread the program's first
void outliveDisplay() noexcept;

/// Returns whether the display has gone since.
[[nodiscard]] bool displayHasGone() noexcept;

} // namespace palp
