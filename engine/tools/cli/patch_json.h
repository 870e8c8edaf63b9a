#pragma once
#include <optional>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/pipeline/patch.h"

namespace palp {

/// Returns every number of a touch, in SI units, for --json and touch.json.
/// \param object  of which the patch is, with these settings
/// \param force   presses [N]; the patch itself holds responses to 1 N
[[nodiscard]] nlohmann::json patchJson(const SoftObject& object, const Patch& patch, const PatchSettings& settings,
                                       double force, PlateSolver& solver);

/// Returns the scene constants of a touch.
[[nodiscard]] nlohmann::json settingsJson(const Material& material, const PatchSettings& settings);

} // namespace palp
