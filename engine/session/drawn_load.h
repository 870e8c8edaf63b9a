#pragma once
#include "engine/pipeline/patch.h"
#include "engine/session/tick_record.h"

namespace palp {

/// Returns the force that dents a patch as deep as a record says [N]: that of the hand, unless the material stiffens or
/// relaxes. Then the dent goes with the depth, and creeps under a constant force.
/// \param force       of the hand [N]
/// \param deflection  the largest that was recorded with it [m]
/// \param patch       may be null
[[nodiscard]] double drawnLoad(double force, double deflection, const Patch* patch, const Material& material) noexcept;
[[nodiscard]] double drawnLoad(const TickRecord& record, const Patch* patch, const Material& material) noexcept;

} // namespace palp
