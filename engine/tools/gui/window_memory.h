#pragma once
#include <glm/vec2.hpp>

namespace palp {

/// The size that the user gave the window last, from $XDG_CONFIG_HOME/palpate/window.json or ~/.config; 1280 x 720 if
/// there is none, or none that makes sense. [px]
[[nodiscard]] glm::ivec2 rememberedSize();

/// Writes it there; where that cannot be done it is forgotten.
void rememberSize(const glm::ivec2& size) noexcept;

} // namespace palp
