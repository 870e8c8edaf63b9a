#include "engine/tools/gui/glfw_display.h"

#include <atomic>

#include <dlfcn.h>

namespace palp {
namespace {

std::atomic<bool> hasGone{false};

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

} // namespace

void outliveDisplay() noexcept
{
    const auto displayOf = find<Display*()>(RTLD_DEFAULT, "glfwGetX11Display");
    void*      x11       = displayOf ? ::dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD) : nullptr;
    if (!x11) return;
    Display* const display     = displayOf();
    const auto     onGone      = find<SetOnGone>(x11, "XSetIOErrorExitHandler");  // instead of exit()
    const auto     onLastWords = find<SetOnLastWords>(x11, "XSetIOErrorHandler"); // instead of its own sentence
    if (!display || !onGone || !onLastWords) return;
    onLastWords([](Display*) {
        hasGone = true;
        return 0;
    });
    onGone(
        display, [](Display*, void*) {}, nullptr);
}

bool displayHasGone() noexcept
{
    return hasGone;
}

} // namespace palp
