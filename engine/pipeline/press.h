#pragma once
#include "engine/cloud/material.h"
#include "engine/force/depth_law.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns how the tangent changes with the hand's depth where the plate is pressed far: contact, and shear across a
/// shell, are springs in series with it. None for a linear patch.
[[nodiscard]] DepthShape depthShapeOf(const Patch& patch) noexcept;

/// The elastic law of a patch, without a cap: that of the place, not of a device.
[[nodiscard]] DepthLaw depthLawOf(const Patch& patch) noexcept;

/// What a force does to a patch. Where the force stiffens with depth, the dent does not grow with the force, but with
/// the depth: it is the one that `load` makes of a linear plate. The same holds of a sheet that is pressed far. A
/// linear one has load = force, to the bit.
struct Press {
    double depth = 0; ///< of the hand at once [m]
    double load  = 0; ///< times the patch's response is the dent [N]
    double later = 0; ///< depth after so long that nothing relaxes any more [m]
};

/// \param force  of 0 or more [N]
/// \pre patch.deformed()
[[nodiscard]] Press pressOf(const Patch& patch, const Material& material, double force) noexcept;

/// Returns the force at which pressOf() has a dent, by the law of large deflections [N].
/// \param dent  of the plate under the fingertip's mean [m], at most that law's reach
/// \pre patch.large
[[nodiscard]] double forceToDent(const Patch& patch, double dent) noexcept;

} // namespace palp
