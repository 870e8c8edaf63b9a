#pragma once
#include <functional>

namespace palp {

/// Starts GLFW, in a program that outlives its display: Xlib ends one whose X server has gone, by exit() in the middle of
/// whatever its threads do, and where it is kept from that, it crashes in the next of its calls.
/// \return false: there is no display, see glfwGetError
/// \thread the program's first
[[nodiscard]] bool startDisplay();

/// Makes calls of GLFW that may ask something of the display, unless it has gone. Where it goes meanwhile they are left in
/// the middle, by longjmp, and GLFW must not be called any more. Other desktops than X close their windows by GLFW.
/// \param calls  with nothing in them that has to be destroyed or unlocked, and no Vulkan driver
/// \return false: it has gone
/// \thread the program's first
bool withDisplay(const std::function<void()>& calls);

/// Returns whether the display has gone since.
[[nodiscard]] bool displayHasGone() noexcept;

} // namespace palp
