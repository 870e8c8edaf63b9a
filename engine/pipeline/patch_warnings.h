#pragma once
#include <string>
#include <vector>

#include "engine/pipeline/patch.h"

namespace palp {

/// What a user must know about a result, in sentences: where theory or data end. Empty is good.
/// \param force  that presses [N]
[[nodiscard]] std::vector<std::string> warnings(const Patch& patch, const PatchSettings& settings, double force);

} // namespace palp
