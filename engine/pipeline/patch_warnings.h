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

/// Returns the stiffness of the membrane that a plate leaves out, over what else resists the slowest wave in the
/// window [1].
/// \param curvature  of the surface, the larger one [1/m]
[[nodiscard]] double    membraneLeftOut(const Patch& patch, const PatchSettings& settings, const Material& material,
                                        double curvature);
inline constexpr double kMembraneFelt = 0.2; ///< more is said [1]

/// Returns the sentence that says so.
[[nodiscard]] std::string bentFlat(double curvature);

/// Returns the one of them about a plate that was not solved as well as asked for.
/// \pre !patch.report.converged
[[nodiscard]] std::string unconvergedText(const Patch& patch);

} // namespace palp
