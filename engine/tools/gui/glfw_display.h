#pragma once
#include <functional>

namespace palp {

/// Starts GLFW, in a program that outlives its display: Xlib ends one whose X server has gone, by exit() in the middle
/// of whatever its threads do, and where it is kept from that, it crashes in the next of its calls.
/// \return false: there is no display, see glfwGetError
/// \thread the program's first
[[nodiscard]] bool startDisplay();

/// Makes calls of GLFW that may ask something of the display, unless it has gone. Where it goes meanwhile they are left
/// in the middle, by longjmp, and GLFW must not be called any more. Other desktops than X close their windows by GLFW.
/// \param calls  with nothing in them that has to be destroyed or unlocked, and no Vulkan driver
/// \return false: it has gone
/// \thread the program's first
bool withDisplay(const std::function<void()>& calls);

/// While it lives, a crash beside a display that has gone ends the program by one sentence and exit code 2, any other
/// one as always. For a driver's first questions of a display, before there is a recording, paint or a force: Mesa 22
/// reads an answer of XFixes that never came (10 of 1000 windows whose display goes just then).
/// \thread the program's first, one at a time
class CrashesWithDisplay {
public:
    CrashesWithDisplay();
    CrashesWithDisplay(const CrashesWithDisplay&)            = delete;
    CrashesWithDisplay& operator=(const CrashesWithDisplay&) = delete;
    ~CrashesWithDisplay();
};

/// Returns whether the display has gone since.
[[nodiscard]] bool displayHasGone() noexcept;

} // namespace palp
