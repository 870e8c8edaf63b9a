#pragma once
#include <string>

#include "engine/plate/plate.h"

namespace palp {

/// Returns what is known of an answer that did not converge: "its error is about 0.06 or more, relative".
[[nodiscard]] std::string errorText(const SolveReport& report);

} // namespace palp
