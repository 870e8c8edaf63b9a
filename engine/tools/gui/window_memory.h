#pragma once
#include <glm/vec2.hpp>

namespace palp {

/// Returns the size that the user gave the window last, from $XDG_CONFIG_HOME/palpate/window.json or ~/.config; 1280 x
/// 720 if there is none that can be used [px].
[[nodiscard]] glm::ivec2 rememberedSize();

/// Writes the size to that file; if it cannot be written, the size is forgotten.
void rememberSize(const glm::ivec2& size) noexcept;

} // namespace palp
