#pragma once
#include <string>
#include <vector>

#include "engine/pipeline/patch.h"
#include "engine/pipeline/press.h"

namespace palp {

/// Returns, in sentences, the limits of theory and data that a user of a result must know. Empty is good.
/// \param force     that presses [N]
/// \param material  says how deep that is; by default a linear one
[[nodiscard]] std::vector<std::string> warnings(const Patch& patch, const PatchSettings& settings, double force,
                                                const Material& material = {});

} // namespace palp
