#pragma once
#include <string>

namespace palp {

/// What this machine's processor calls itself, or "unknown processor".
[[nodiscard]] std::string processorName();

} // namespace palp
