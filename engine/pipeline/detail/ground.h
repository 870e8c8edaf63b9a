#pragma once
#include "engine/core/grid.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns the share of each node that is held in the sheet's plane [1]: Patch::held, and what belongs to it up to the
/// border and beyond.
///
/// Between what is held and a border right behind it a rim of the sheet may be left, as behind a row of balls, or where
/// points scatter. It is narrower than the grid or the points can tell, carries nothing, and counts as held; so does
/// an overhang that is cut off by what is held, and not touched itself. Beyond the border a node is ground where the
/// nearest node of the sheet is held. Without that, each remnant of a rim parted the ground behind it, up to the sides
/// of the window: into pieces that counted as supports or free borders of their own, or so that the free borders on
/// either side of a support became one, and it carried no force.
/// \pre the patch has a border and something is held
[[nodiscard]] NodeField heldUpToBorder(const Patch& patch);

} // namespace palp
