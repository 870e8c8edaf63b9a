#pragma once
#include <string>
#include <vector>

#include "engine/pipeline/patch.h"
#include "engine/pipeline/press.h"

namespace palp {

/// Returns, in sentences, the limits of theory and data that a user of a result must know. Empty is good.
/// \param settings  as the scene has them, or settledFor() it
/// \param force     that presses [N]
/// \param material  of the object
[[nodiscard]] std::vector<std::string> warnings(const Patch& patch, const PatchSettings& settings, double force,
                                                const Material& material);

/// Returns the one of them about a plate that was not solved as well as asked for.
/// \pre !patch.report.converged
[[nodiscard]] std::string unconvergedText(const Patch& patch);

} // namespace palp
