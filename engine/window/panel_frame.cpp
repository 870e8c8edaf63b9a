#include "engine/window/panel_frame.h"

#include <imgui.h>

#include "engine/viewer/text.h"

namespace palp {
namespace {

constexpr float kFontSize = 15; ///< at scale 1 [px]

} // namespace

PanelFrame::PanelFrame(double scale)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io    = ImGui::GetIO();
    io.IniFilename = nullptr; // where panels are is ours to say
    io.LogFilename = nullptr;
    ImFontConfig font;
    font.FontDataOwnedByAtlas = false;
    const auto bytes          = fontBytes();
    // Latin with Greek, and the signs of units and of keys.
    static constexpr ImWchar kGlyphs[] = {0x20,   0xFF,   0x391,  0x3C9,  0x2010, 0x2026, 0x2070, 0x209F,
                                          0x2190, 0x2193, 0x2212, 0x2212, 0x2265, 0x2265, 0};
    // ImGui asks for a pointer that it does not write through.
    io.Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(bytes.data()), int(bytes.size()),
                                   kFontSize * float(scale), &font, kGlyphs);
    ImGui::GetStyle().ScaleAllSizes(float(scale));
    setDark(false);
}

PanelFrame::~PanelFrame()
{
    ImGui::DestroyContext();
}

void PanelFrame::setDark(bool dark)
{
    dark ? ImGui::StyleColorsDark() : ImGui::StyleColorsLight();
    ImGuiStyle& style    = ImGui::GetStyle();
    style.WindowRounding = style.FrameRounding = 3;
    style.Colors[ImGuiCol_WindowBg].w          = 0.92F; // a hint of what is below
}

void PanelFrame::beginWithoutWindow(const glm::ivec2& size, const PanelPointer& pointer)
{
    ImGuiIO& io     = ImGui::GetIO();
    io.DisplaySize  = ImVec2(float(size.x), float(size.y));
    io.DeltaTime    = 1.0F / 60; // [s] always the same: pictures are
    io.MousePos     = ImVec2(float(pointer.at.x), float(pointer.at.y));
    io.MouseDown[0] = pointer.down;
    ImGui::NewFrame();
}

void PanelFrame::end()
{
    ImGui::Render();
}

} // namespace palp
