#pragma once
#include <imgui.h>

namespace palp {

/// Makes the pixels of the panels' font, which a renderer would ask for where there is one.
inline void makeUnseenFont()
{
    unsigned char* pixels = nullptr;
    int            width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
}

} // namespace palp
