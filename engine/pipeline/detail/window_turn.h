#pragma once
#include "engine/pipeline/detail/touched_surface.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns the chart's axes turned so that the corners of the window lie along the principal directions of the touched
/// surface, by the least angle that does; of a window with clamped edges the sides lie there. They stay as they are
/// where it bends nearly alike both ways, for a plate, and where the sides are not all supported or all clamped.
///
/// The dent of a shell that is curved both ways unequally reaches farthest along these directions, and a square
/// farthest to its corners. So what is felt does not depend on how the object, or the hand's way to the place, has
/// turned the chart: with sides along these directions it is up to 30 % stiffer in a window of 8 lengths, where one
/// curvature is 8 times the other.
/// \param chart    of the patch
/// \param surface  its normals towards the finger
[[nodiscard]] Frame turnedToBend(const Chart& chart, const SoftObject& object, const TouchedSurface& surface,
                                 const PatchSettings& settings);

} // namespace palp
