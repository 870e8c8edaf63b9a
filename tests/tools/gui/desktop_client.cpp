#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <X11/Xatom.h>
#include <X11/Xlib.h>

// What a window manager and a file manager do to a window, and xdotool cannot: asks it to close, and lets files fall on
// it. Used by desktop.sh.
//   palp_desktop_client WINDOW close
//   palp_desktop_client WINDOW drop PATH...
// Sources: ICCCM 2.0, 4.2.8.1 "Window deletion"; "Drag-and-Drop Protocol for the X Window System" (XDND), version 5.

namespace {

constexpr double kPatience = 20; // [s] for an answer of the program, which may be drawing in software

/// "file:///a%20b": everything but letters, digits and "-._~/" by its number (RFC 3986).
std::string addressOf(const std::filesystem::path& path)
{
    std::string address = "file://";
    for (const char c : std::filesystem::absolute(path).string()) {
        if (std::isalnum(static_cast<unsigned char>(c)) || std::string_view("-._~/").find(c) != std::string_view::npos)
            address += c;
        else {
            char text[4];
            std::snprintf(text, sizeof text, "%%%02X", static_cast<unsigned char>(c));
            address += text;
        }
    }
    return address;
}

class Client {
public:
    explicit Client(Window target) : target_(target), display_(XOpenDisplay(nullptr))
    {
        if (!display_) throw std::runtime_error("there is no display");
        own_ = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
    }
    ~Client() { XCloseDisplay(display_); }
    Client(const Client&)            = delete;
    Client& operator=(const Client&) = delete;

    void close()
    {
        tell("WM_PROTOCOLS", {long(atom("WM_DELETE_WINDOW")), CurrentTime, 0, 0, 0});
        XSync(display_, False);
    }

    /// Enters, waits until the window would take them, lets go, hands them over, waits until it has them.
    void drop(const std::string& addresses)
    {
        constexpr long kVersion = 5;
        refuseUnaware();
        XSetSelectionOwner(display_, atom("XdndSelection"), own_, CurrentTime);
        tell("XdndEnter", {long(own_), kVersion << 24, long(atom("text/uri-list")), 0, 0});
        tell("XdndPosition", {long(own_), 0, middle(), CurrentTime, long(atom("XdndActionCopy"))});
        if ((waitFor("XdndStatus", addresses).data.l[1] & 1) == 0)
            throw std::runtime_error("the window does not take what is over it");
        tell("XdndDrop", {long(own_), 0, CurrentTime, 0, 0});
        waitFor("XdndFinished", addresses);
        if (!served_) throw std::runtime_error("the window has never asked what fell on it");
    }

private:
    Atom atom(const char* name) { return XInternAtom(display_, name, False); }

    void tell(const char* what, const std::vector<long>& words)
    {
        XEvent event{};
        event.xclient.type         = ClientMessage;
        event.xclient.window       = target_;
        event.xclient.message_type = atom(what);
        event.xclient.format       = 32;
        for (std::size_t n = 0; n < words.size(); ++n) event.xclient.data.l[n] = words[n];
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    void refuseUnaware()
    {
        Atom           type   = None;
        int            format = 0;
        unsigned long  count = 0, left = 0;
        unsigned char* version = nullptr;
        XGetWindowProperty(display_, target_, atom("XdndAware"), 0, 1, False, XA_ATOM, &type, &format, &count, &left,
                           &version);
        if (version) XFree(version);
        if (count == 0) throw std::runtime_error("the window says that nothing may be dropped on it");
    }

    /// Of the window, on the screen: x in the upper half of the word.
    long middle()
    {
        XWindowAttributes now{};
        XGetWindowAttributes(display_, target_, &now);
        int    x = 0, y = 0;
        Window child = None;
        XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), now.width / 2, now.height / 2, &x, &y,
                              &child);
        return long(x) << 16 | y;
    }

    /// Hands over the addresses whenever they are asked for, until the message comes.
    XClientMessageEvent waitFor(const char* what, const std::string& addresses)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience);
        while (std::chrono::steady_clock::now() < end) {
            if (XPending(display_) == 0) {
                const timespec pause{0, 5'000'000};
                nanosleep(&pause, nullptr);
                continue;
            }
            XEvent event{};
            XNextEvent(display_, &event);
            if (event.type == SelectionRequest) serve(event.xselectionrequest, addresses);
            if (event.type == ClientMessage && event.xclient.message_type == atom(what)) return event.xclient;
        }
        throw std::runtime_error(std::string("no ") + what + " from the window");
    }

    void serve(const XSelectionRequestEvent& asked, const std::string& addresses)
    {
        XChangeProperty(display_, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(addresses.data()), int(addresses.size()));
        XEvent answer{};
        answer.xselection = {SelectionNotify, 0,         True, display_, asked.requestor, asked.selection, asked.target,
                             asked.property,  asked.time};
        XSendEvent(display_, asked.requestor, False, NoEventMask, &answer);
        XFlush(display_);
        served_ = true;
    }

    Window   target_, own_ = None;
    Display* display_;
    bool     served_ = false;
};

} // namespace

int main(int count, char** words)
try {
    const std::vector<std::string> arguments(words + 1, words + count);
    if (arguments.size() < 2) throw std::runtime_error("expected WINDOW close, or WINDOW drop PATH...");
    Client client(std::strtoul(arguments[0].c_str(), nullptr, 0));
    if (arguments[1] == "close") {
        client.close();
    } else {
        std::string addresses;
        for (std::size_t n = 2; n < arguments.size(); ++n) addresses += addressOf(arguments[n]) + "\r\n";
        client.drop(addresses);
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "palp_desktop_client: %s\n", error.what());
    return 1;
}
