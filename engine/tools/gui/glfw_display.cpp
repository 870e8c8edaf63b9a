#include "engine/tools/gui/glfw_display.h"

#include <atomic>
#include <csetjmp>
#include <string_view>

#include <dlfcn.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <GLFW/glfw3.h>

namespace palp {
namespace {

std::atomic<bool> hasGone{false};

// Of the calls that this thread is making; a driver's threads may meet the end as well.
thread_local std::jmp_buf wayOut;
thread_local bool         isWithin = false;

// Of libX11, whose header is not needed for building and which may not be there.
using Display        = void;
using OnGone         = void(Display*, void*);
using SetOnGone      = void(Display*, OnGone*, void*);
using OnLastWords    = int(Display*);
using SetOnLastWords = OnLastWords*(OnLastWords*);
using Unlock         = void(Display*);
using NumberOf       = int(Display*);

Unlock* unlock = nullptr; // XUnlockDisplay

template <class Function>
Function* find(void* library, const char* name)
{
    return reinterpret_cast<Function*>(::dlsym(library, name));
}

/// In the place of Xlib's own sentence.
int notice(Display* display)
{
    hasGone = true;
    if (!isWithin) return 0;
    if (unlock) unlock(display); // Xlib has locked it for an exit, and others would wait for ever
    std::longjmp(wayOut, 1);
}

int              socketOfDisplay = -1; // of X; other desktops have none
struct sigaction before {};

/// Of SIGSEGV; nothing here allocates or locks.
void endWithDisplay(int number)
{
    pollfd         display{socketOfDisplay, POLLIN, 0};
    constexpr auto kSentence = std::string_view("palpate: the display has gone, and the window with it\n");
    if (::poll(&display, 1, 0) == 1 && (display.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
        const auto written = ::write(STDERR_FILENO, kSentence.data(), kSentence.size());
        ::_exit(written == ssize_t(kSentence.size()) ? 2 : 1);
    }
    ::sigaction(number, &before, nullptr); // the same instruction crashes again
}

} // namespace

CrashesWithDisplay::CrashesWithDisplay()
{
    if (socketOfDisplay < 0) return;
    struct sigaction now {};
    now.sa_handler = endWithDisplay;
    ::sigaction(SIGSEGV, &now, &before);
}

CrashesWithDisplay::~CrashesWithDisplay()
{
    if (socketOfDisplay >= 0) ::sigaction(SIGSEGV, &before, nullptr);
}

bool startDisplay()
{
    void* const x11 = ::dlopen("libX11.so.6", RTLD_NOW); // as GLFW does
    if (x11) unlock = find<Unlock>(x11, "XUnlockDisplay");
    if (const auto onLastWords = x11 ? find<SetOnLastWords>(x11, "XSetIOErrorHandler") : nullptr) onLastWords(notice);
    bool started = false;
    if (!withDisplay([&] { started = glfwInit() != 0; }) || !started) return false;
    // A driver that meets the end by Xlib, outside of our calls, goes on with what means nothing: libX11 1.7 and later.
    const auto displayOf = find<Display*()>(RTLD_DEFAULT, "glfwGetX11Display");
    const auto onGone    = x11 ? find<SetOnGone>(x11, "XSetIOErrorExitHandler") : nullptr;
    const auto numberOf  = x11 ? find<NumberOf>(x11, "XConnectionNumber") : nullptr;
    Display*   display   = displayOf ? displayOf() : nullptr;
    if (display && numberOf) socketOfDisplay = numberOf(display);
    if (display && onGone)
        onGone(
            display, [](Display*, void*) {}, nullptr);
    return true;
}

bool withDisplay(const std::function<void()>& calls)
{
    if (hasGone) return false;
    if (setjmp(wayOut) == 0) {
        isWithin = true;
        try {
            calls();
        } catch (...) {
            isWithin = false;
            throw;
        }
    }
    isWithin = false;
    return !hasGone;
}

bool displayHasGone() noexcept
{
    return hasGone;
}

} // namespace palp
