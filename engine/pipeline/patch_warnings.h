#pragma once
#include <string>
#include <vector>

#include "engine/pipeline/patch.h"

namespace palp {

/// Returns, in sentences, the limits of theory and data that a user of a result must know. Empty is good.
/// \param force  that presses [N]
[[nodiscard]] std::vector<std::string> warnings(const Patch& patch, const PatchSettings& settings, double force);

} // namespace palp
