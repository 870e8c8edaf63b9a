#pragma once
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace palp {

/// Returns the size that the user gave the window last, from $XDG_CONFIG_HOME/palpate/window.json or ~/.config; 1280 x
/// 720 if there is none that can be used [px].
[[nodiscard]] glm::ivec2 rememberedSize();

/// Writes the size to that file; if it cannot be written, the size is forgotten.
void rememberSize(const glm::ivec2& size) noexcept;

/// Returns the files that were opened last, newest first, at most eight; of those that are still there.
[[nodiscard]] std::vector<std::string> rememberedFiles();

/// Puts a file in front of them; if that cannot be written, the file is forgotten.
/// \param file  an absolute path
void rememberFile(const std::string& file) noexcept;

/// Returns whether nothing is remembered: this user has never had a window.
[[nodiscard]] bool isFirstWindow();

} // namespace palp
