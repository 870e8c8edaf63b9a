#pragma once
#include <optional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/pipeline/patch.h"

namespace palp {

/// Returns every number of a touch, in SI units, for --json and touch.json.
/// \param force  presses [N]; the patch itself holds responses to 1 N
[[nodiscard]] nlohmann::json patchJson(const Patch& patch, const Material& material, const PatchSettings& settings,
                                       double force, PlateSolver& solver);

/// Returns the scene constants of a touch.
[[nodiscard]] nlohmann::json settingsJson(const Material& material, const PatchSettings& settings);

} // namespace palp
