#pragma once
#include <optional>

#include "engine/pipeline/detail/touched_surface.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Fits the sphere near the contact, equations 1 to 3: patch.sphere. Where the proxy feels a surface, its plane is
/// taken if the fit is none or disagrees by more than 60 degrees, as at a rim.
void fitSphereTo(Patch& patch, const SoftObject& object, const Ball& ball, const TouchedSurface& surface,
                 const PatchSettings& settings);

/// Returns the chart about the contact, equation 4, on the hand's side of the surface; sets patch.sideUnsure.
///
/// A known direction decides unless it runs along the surface. A guessed one decides only where it is within 60 degrees
/// of the normal; elsewhere the surface is an open sheet, which has no outside: there it is touched from the positive
/// side of the world axis nearest to its normal, so that all of a sheet is touched from one side.
/// \throws Error if a known direction runs along the surface
[[nodiscard]] Chart chartAt(Patch& patch, const SoftObject& object, Map map, const std::optional<Frame>& carried);

} // namespace palp
