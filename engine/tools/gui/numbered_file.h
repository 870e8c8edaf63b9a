#pragma once
#include <filesystem>
#include <string>

namespace palp {

/// Returns the first path "stem-0001.extension", "stem-0002.extension", ... that does not exist yet.
/// \throws Error if all 9999 exist, or as isThere()
[[nodiscard]] std::filesystem::path unusedPath(const std::string& stem, const std::string& extension);

} // namespace palp
