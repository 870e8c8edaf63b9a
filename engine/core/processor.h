#pragma once
#include <string>

namespace palp {

/// Returns the name that this machine's processor gives itself, or "unknown processor".
[[nodiscard]] std::string processorName();

} // namespace palp
