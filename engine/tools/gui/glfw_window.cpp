#include "engine/tools/gui/glfw_window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <vulkan/vulkan.h>

#include <GLFW/glfw3.h>

#include "engine/core/contract.h"
#include "engine/tools/gui/glfw_display.h"

namespace palp {
namespace {

/// Returns GLFW's last error, or nothing.
std::string reason()
{
    const char* text = nullptr;
    return glfwGetError(&text) != GLFW_NO_ERROR && text ? std::string(" (") + text + ")" : std::string();
}

/// Returns the number of a key; 0 for keys that nothing uses.
int keyOf(int key, int scancode)
{
    switch (key) {
    case GLFW_KEY_TAB:
        return kTabKey;
    case GLFW_KEY_ESCAPE:
        return kEscapeKey;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
        return kEnterKey;
    case GLFW_KEY_BACKSPACE:
        return kBackspaceKey;
    case GLFW_KEY_DELETE:
        return kDeleteKey;
    case GLFW_KEY_LEFT:
        return kLeftKey;
    case GLFW_KEY_RIGHT:
        return kRightKey;
    case GLFW_KEY_HOME:
        return kHomeKey;
    case GLFW_KEY_END:
        return kEndKey;
    case GLFW_KEY_F1:
        return kF1Key;
    case GLFW_KEY_F5:
        return kF5Key;
    case GLFW_KEY_F6:
        return kF6Key;
    case GLFW_KEY_F7:
        return kF7Key;
    default:
        break;
    }
    const char* const name  = glfwGetKeyName(key, scancode);    // null if it writes nothing
    const int         place = key > ' ' && key < 128 ? key : 0; // GLFW's numbers are ASCII there
    return keyNumber(place, name ? name : "");
}

} // namespace

struct GlfwWindow::Impl {
    GLFWwindow* window = nullptr;
    WindowInput input;             ///< collected since the last poll
    bool        holdsH  = false;   ///< as the layout has it
    double      pressed = -1e9;    ///< when the left button went down last [s]
    glm::ivec2  pixels{}, units{}; ///< size of the picture [px], of the window as the desktop measures
    glm::dvec2  at{};              ///< the pointer, as the desktop measures

    static Impl& of(GLFWwindow* window) { return *static_cast<Impl*>(glfwGetWindowUserPointer(window)); }
    void         listen();
    void         ask();
    void         readState();
};

void GlfwWindow::Impl::listen()
{
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
        Impl&     self   = of(w);
        const int number = keyOf(key, scancode);
        if (number == 'H') self.holdsH = action != GLFW_RELEASE;
        if (action != GLFW_RELEASE && number != 0)
            self.input.keys.push_back(
                {number, (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0, action == GLFW_REPEAT});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) { of(w).input.wheel += y; });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        constexpr double kDouble = 0.3; // [s] longest time between the two clicks
        if (button != GLFW_MOUSE_BUTTON_LEFT || action != GLFW_PRESS) return;
        Impl&        self      = of(w);
        const double now       = glfwGetTime();
        self.input.leftPressed = true;
        self.input.doubleClick |= now - self.pressed < kDouble;
        self.pressed = now;
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int code) { of(w).input.typed.push_back(code); });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        for (int n = 0; n < count; ++n) of(w).input.dropped.emplace_back(paths[n]);
    });
}

/// Asks for the sizes and the pointer's place, in the desktop's units. Each question is a round trip to the desktop,
/// which is slow while pictures are on the way there; later values come by GLFW's callbacks.
void GlfwWindow::Impl::ask()
{
    glfwGetFramebufferSize(window, &pixels.x, &pixels.y);
    glfwGetWindowSize(window, &units.x, &units.y);
    glfwGetCursorPos(window, &at.x, &at.y);
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int x, int y) { of(w).pixels = {x, y}; });
    glfwSetWindowSizeCallback(window, [](GLFWwindow* w, int x, int y) { of(w).units = {x, y}; });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { of(w).at = {x, y}; });
    glfwSetWindowContentScaleCallback(window,
                                      [](GLFWwindow* w, float x, float) { of(w).input.scale = std::max(1.0F, x); });
}

/// Reads the held keys and buttons, and converts everything to pixels.
void GlfwWindow::Impl::readState()
{
    const auto held    = [this](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
    const auto button  = [this](int which) { return glfwGetMouseButton(window, which) == GLFW_PRESS; };
    glm::dvec2 pointer = at;
    if (units.x > 0 && units.y > 0) pointer *= glm::dvec2(pixels) / glm::dvec2(units);

    input.moved   = input.size.x > 0 ? pointer - input.pointer : glm::dvec2(0);
    input.pointer = pointer;
    input.size    = pixels;
    input.left    = button(GLFW_MOUSE_BUTTON_LEFT);
    input.right   = button(GLFW_MOUSE_BUTTON_RIGHT);
    input.middle  = button(GLFW_MOUSE_BUTTON_MIDDLE);
    input.shift   = held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT);
    input.touch   = held(GLFW_KEY_SPACE) || holdsH;
    input.closing = glfwWindowShouldClose(window) != 0;
}

GlfwWindow::GlfwWindow(const std::string& title, const glm::ivec2& size) : impl_(std::make_unique<Impl>())
{
    constexpr const char* kHint = "; palpate render makes pictures without a display";
    if (!startDisplay()) throw Error("no window can be opened: there is no display" + reason() + kHint);
    if (!glfwVulkanSupported()) {
        const std::string why = reason();
        withDisplay([] { glfwTerminate(); });
        throw Error("no window can be opened: no Vulkan driver shows pictures on this display" + why + kHint);
    }
    const bool hasIt = withDisplay([&] {
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        impl_->window = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
        if (!impl_->window) return;
        impl_->listen();
        impl_->ask();
        impl_->input.scale = scale();
    });
    if (!hasIt) throw Error(std::string("the display has gone while the window was opened") + kHint);
    if (!impl_->window) {
        const std::string why = reason();
        withDisplay([] { glfwTerminate(); });
        throw Error("no window can be opened on this display" + why + kHint);
    }
}

GlfwWindow::~GlfwWindow()
{
    withDisplay([this] {
        glfwDestroyWindow(impl_->window);
        glfwTerminate();
    });
}

WindowLink GlfwWindow::link()
{
    std::uint32_t            count = 0;
    const char** const       names = glfwGetRequiredInstanceExtensions(&count);
    std::vector<std::string> extensions(names, names + count);
    return {std::move(extensions), [window = impl_->window](void* instance) {
                VkSurfaceKHR   surface = VK_NULL_HANDLE;
                const VkResult made =
                    glfwCreateWindowSurface(static_cast<VkInstance>(instance), window, nullptr, &surface);
                if (made != VK_SUCCESS) throw Error("Vulkan cannot show pictures in this window" + reason());
                return reinterpret_cast<std::uint64_t>(surface);
            }};
}

WindowInput GlfwWindow::poll(double patience)
{
    const bool hasIt = withDisplay([patience] {
        if (patience > 0)
            glfwWaitEventsTimeout(patience);
        else
            glfwPollEvents();
    });
    if (hasIt) impl_->readState();
    impl_->input.closing |= !hasDisplay();
    WindowInput result       = impl_->input;
    impl_->input.wheel       = 0;
    impl_->input.leftPressed = impl_->input.doubleClick = false;
    impl_->input.keys.clear();
    impl_->input.typed.clear();
    impl_->input.dropped.clear();
    return result;
}

void GlfwWindow::setTitle(const std::string& title)
{
    withDisplay([&] { glfwSetWindowTitle(impl_->window, title.c_str()); });
}

bool GlfwWindow::hasDisplay() const noexcept
{
    return !displayHasGone();
}

double GlfwWindow::scale() const
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(impl_->window, &x, &y);
    return std::max(1.0F, x);
}

} // namespace palp
