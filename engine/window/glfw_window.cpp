#include "engine/window/glfw_window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <vulkan/vulkan.h>

#include <GLFW/glfw3.h>
#ifdef PALPATE_PANELS
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#endif

#include "engine/core/contract.h"

namespace palp {
namespace {

/// GLFW's last complaint, or nothing.
std::string reason()
{
    const char* text = nullptr;
    return glfwGetError(&text) != GLFW_NO_ERROR && text ? std::string(" (") + text + ")" : std::string();
}

/// 0 for keys that nobody asks for.
int keyOf(int key)
{
    switch (key) {
    case GLFW_KEY_TAB:
        return kTabKey;
    case GLFW_KEY_ESCAPE:
        return kEscapeKey;
    case GLFW_KEY_F1:
        return kF1Key;
    case GLFW_KEY_F5:
        return kF5Key;
    case GLFW_KEY_F6:
        return kF6Key;
    default:
        return key > ' ' && key < 128 ? key : 0; // GLFW's numbers are ASCII there
    }
}

} // namespace

struct GlfwWindow::Impl {
    GLFWwindow* window = nullptr;
    WindowInput input;           ///< collected since the last poll
    double      pressed = -1e9;  ///< when the left button went down last [s]
    bool        panels  = false; ///< ImGui hears first

    static Impl& of(GLFWwindow* window) { return *static_cast<Impl*>(glfwGetWindowUserPointer(window)); }
    void         listen();
    void         readState();
};

void GlfwWindow::Impl::listen()
{
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int mods) {
        if (action != GLFW_RELEASE && keyOf(key) != 0)
            of(w).input.keys.push_back({keyOf(key), (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) { of(w).input.wheel += y; });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        constexpr double kDouble = 0.3; // [s] between the two clicks
        if (button != GLFW_MOUSE_BUTTON_LEFT || action != GLFW_PRESS) return;
        Impl&        self      = of(w);
        const double now       = glfwGetTime();
        self.input.leftPressed = true;
        self.input.doubleClick |= now - self.pressed < kDouble;
        self.pressed = now;
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        for (int n = 0; n < count; ++n) of(w).input.dropped.emplace_back(paths[n]);
    });
}

/// What GLFW keeps itself: sizes, places, what is held.
void GlfwWindow::Impl::readState()
{
    const auto held   = [this](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
    const auto button = [this](int which) { return glfwGetMouseButton(window, which) == GLFW_PRESS; };
    int        width = 0, height = 0, wide = 0, high = 0;
    glfwGetFramebufferSize(window, &width, &height);
    glfwGetWindowSize(window, &wide, &high);
    glm::dvec2 at;
    glfwGetCursorPos(window, &at.x, &at.y);
    if (wide > 0 && high > 0) at *= glm::dvec2(width, height) / glm::dvec2(wide, high); // screens' units are no pixels
    float scale = 1, unused = 1;
    glfwGetWindowContentScale(window, &scale, &unused);

    input.moved   = input.size.x > 0 ? at - input.pointer : glm::dvec2(0);
    input.pointer = at;
    input.size    = {width, height};
    input.scale   = std::max(1.0F, scale);
    input.left    = button(GLFW_MOUSE_BUTTON_LEFT);
    input.right   = button(GLFW_MOUSE_BUTTON_RIGHT);
    input.middle  = button(GLFW_MOUSE_BUTTON_MIDDLE);
    input.shift   = held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT);
    input.touch   = held(GLFW_KEY_SPACE) || held(GLFW_KEY_H);
    input.closing = glfwWindowShouldClose(window) != 0;
#ifdef PALPATE_PANELS
    if (panels) {
        input.panelsTakePointer = ImGui::GetIO().WantCaptureMouse;
        input.panelsTakeKeys    = ImGui::GetIO().WantTextInput;
    }
#endif
}

GlfwWindow::GlfwWindow(const std::string& title, const glm::ivec2& size) : impl_(std::make_unique<Impl>())
{
    constexpr const char* kHint = "; palpate render makes pictures without a display";
    if (!glfwInit()) throw Error("no window can be opened: there is no display" + reason() + kHint);
    if (!glfwVulkanSupported()) {
        const std::string why = reason();
        glfwTerminate();
        throw Error("no window can be opened: no Vulkan driver shows pictures on this display" + why + kHint);
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    impl_->window = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!impl_->window) {
        const std::string why = reason();
        glfwTerminate();
        throw Error("no window can be opened on this display" + why + kHint);
    }
    impl_->listen();
}

GlfwWindow::~GlfwWindow()
{
#ifdef PALPATE_PANELS
    if (impl_->panels) ImGui_ImplGlfw_Shutdown();
#endif
    glfwDestroyWindow(impl_->window);
    glfwTerminate();
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
    if (patience > 0)
        glfwWaitEventsTimeout(patience);
    else
        glfwPollEvents();
    impl_->readState();
    WindowInput result       = impl_->input;
    impl_->input.wheel       = 0;
    impl_->input.leftPressed = impl_->input.doubleClick = false;
    impl_->input.keys.clear();
    impl_->input.dropped.clear();
    return result;
}

void GlfwWindow::feedPanels()
{
#ifdef PALPATE_PANELS
    impl_->panels = ImGui_ImplGlfw_InitForVulkan(impl_->window, true);
#endif
}

void GlfwWindow::beginPanels()
{
#ifdef PALPATE_PANELS
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
#endif
}

void GlfwWindow::setTitle(const std::string& title)
{
    glfwSetWindowTitle(impl_->window, title.c_str());
}

double GlfwWindow::scale() const
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(impl_->window, &x, &y);
    return std::max(1.0F, x);
}

} // namespace palp
