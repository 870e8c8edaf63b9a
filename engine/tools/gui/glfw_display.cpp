#include "engine/tools/gui/glfw_display.h"

#include <atomic>
#include <csetjmp>

#include <dlfcn.h>

#include <GLFW/glfw3.h>

namespace palp {
namespace {

std::atomic<bool> hasGone{false};
std::jmp_buf      wayOut;           // of the calls that are being made
bool              isWithin = false; // them; no other thread calls GLFW

// Of libX11, whose header is not needed for building and which may not be there.
using Display        = void;
using OnGone         = void(Display*, void*);
using SetOnGone      = void(Display*, OnGone*, void*);
using OnLastWords    = int(Display*);
using SetOnLastWords = OnLastWords*(OnLastWords*);

template <class Function>
Function* find(void* library, const char* name)
{
    return reinterpret_cast<Function*>(::dlsym(library, name));
}

/// In the place of Xlib's own sentence.
int notice(Display*)
{
    hasGone = true;
    if (isWithin) std::longjmp(wayOut, 1);
    return 0;
}

} // namespace

bool startDisplay()
{
    void* const x11 = ::dlopen("libX11.so.6", RTLD_NOW); // as GLFW does
    if (const auto onLastWords = x11 ? find<SetOnLastWords>(x11, "XSetIOErrorHandler") : nullptr) onLastWords(notice);
    bool started = false;
    if (!withDisplay([&] { started = glfwInit() != 0; }) || !started) return false;
    // A driver that meets the end by Xlib, outside of our calls, goes on with what means nothing: libX11 1.7 and later.
    const auto displayOf = find<Display*()>(RTLD_DEFAULT, "glfwGetX11Display");
    const auto onGone    = x11 ? find<SetOnGone>(x11, "XSetIOErrorExitHandler") : nullptr;
    if (Display* const display = displayOf ? displayOf() : nullptr; display && onGone)
        onGone(
            display, [](Display*, void*) {}, nullptr);
    return true;
}

bool withDisplay(const std::function<void()>& calls)
{
    if (hasGone) return false;
    if (setjmp(wayOut) == 0) {
        isWithin = true;
        calls();
    }
    isWithin = false;
    return !hasGone;
}

bool displayHasGone() noexcept
{
    return hasGone;
}

} // namespace palp
