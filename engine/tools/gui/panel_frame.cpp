#include "engine/tools/gui/panel_frame.h"

#include <algorithm>

#include <imgui.h>

#include "engine/tools/gui/panel_layout.h"
#include "engine/tools/render/text.h"

namespace palp {

bool PanelFrame::available() noexcept
{
    return true;
}

PanelFrame::PanelFrame(double scale)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io    = ImGui::GetIO();
    io.IniFilename = nullptr; // Palpate lays out the panels
    io.LogFilename = nullptr;
    setScale(scale);
}

PanelFrame::~PanelFrame()
{
    ImGui::DestroyContext();
}

void PanelFrame::setScale(double scale)
{
    if (scale == scale_) return;
    scale_      = scale;
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    ImFontConfig font;
    font.FontDataOwnedByAtlas = false;
    const auto bytes          = fontBytes();
    // The ranges hold Latin, Greek, and the signs of units and keys.
    static constexpr ImWchar kGlyphs[] = {0x20,   0xFF,   0x391,  0x3C9,  0x2010, 0x2026, 0x2070, 0x209F,
                                          0x2190, 0x2193, 0x2212, 0x2212, 0x2265, 0x2265, 0};
    // ImGui takes a non-const pointer but does not write through it.
    io.Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(bytes.data()), int(bytes.size()),
                                   kPanelFont * float(scale), &font, kGlyphs);
#if IMGUI_VERSION_NUM < 19200 // later versions do that while they draw
    io.Fonts->Build();
#endif
    ImGui::GetStyle() = ImGuiStyle(); // sizes are scaled from those of scale 1
    ImGui::GetStyle().ScaleAllSizes(float(scale));
    setDark(dark_);
}

void PanelFrame::setDark(bool dark)
{
    dark_ = dark;
    dark ? ImGui::StyleColorsDark() : ImGui::StyleColorsLight();
    ImGuiStyle& style    = ImGui::GetStyle();
    style.WindowRounding = style.FrameRounding = 3;
    style.Colors[ImGuiCol_WindowBg].w          = 0.92F; // the picture below shows through slightly
}

void PanelFrame::beginWithoutWindow(const glm::ivec2& size, const PanelPointer& pointer)
{
    ImGuiIO& io     = ImGui::GetIO();
    io.DisplaySize  = ImVec2(float(size.x), float(size.y));
    io.DeltaTime    = 1.0F / 60; // [s] constant, so that pictures are the same every time
    io.MousePos     = ImVec2(float(pointer.at.x), float(pointer.at.y));
    io.MouseDown[0] = pointer.down;
    ImGui::NewFrame();
}

namespace {

struct EditKey {
    int      key;
    ImGuiKey meaning;
};
constexpr EditKey kEditKeys[] = {{kTabKey, ImGuiKey_Tab},          {kEscapeKey, ImGuiKey_Escape},
                                 {kEnterKey, ImGuiKey_Enter},      {kBackspaceKey, ImGuiKey_Backspace},
                                 {kDeleteKey, ImGuiKey_Delete},    {kLeftKey, ImGuiKey_LeftArrow},
                                 {kRightKey, ImGuiKey_RightArrow}, {kHomeKey, ImGuiKey_Home},
                                 {kEndKey, ImGuiKey_End}};

bool pressed(const WindowInput& input, int key)
{
    return std::ranges::any_of(input.keys, [key](const KeyPress& press) { return press.key == key; });
}

} // namespace

// Input is given to ImGui here, not by ImGui's back end for GLFW, which asks the desktop for the focus in every frame
// and waits for the answer behind the picture that is on its way there.
WindowInput PanelFrame::begin(WindowInput input)
{
    setScale(input.scale);
    const auto now  = std::chrono::steady_clock::now();
    ImGuiIO&   io   = ImGui::GetIO();
    io.DisplaySize  = ImVec2(float(input.size.x), float(input.size.y));
    io.DeltaTime    = std::clamp(std::chrono::duration<float>(now - last_).count(), 1e-3F, 0.2F);
    last_           = now;
    io.MousePos     = ImVec2(float(input.pointer.x), float(input.pointer.y));
    io.MouseDown[0] = input.left || input.leftPressed; // a click may begin and end between two pictures
    io.MouseDown[1] = input.right;
    io.MouseDown[2] = input.middle;
    io.MouseWheel += float(input.wheel);
    for (const char32_t code : input.typed) io.AddInputCharacter(unsigned(code));
#if IMGUI_VERSION_NUM >= 18700
    for (const EditKey& edit : kEditKeys) io.AddKeyEvent(edit.meaning, pressed(input, edit.key));
#else
    for (const EditKey& edit : kEditKeys) io.KeysDown[io.KeyMap[edit.meaning] = edit.key] = pressed(input, edit.key);
#endif
    ImGui::NewFrame();
    input.panelsTakePointer = io.WantCaptureMouse;
    input.panelsTakeKeys    = io.WantTextInput;
    return input;
}

void PanelFrame::end()
{
    ImGui::Render();
}

} // namespace palp
