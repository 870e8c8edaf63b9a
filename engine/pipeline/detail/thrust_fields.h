#pragma once
#include <vector>

#include "engine/core/grid.h"
#include "engine/pipeline/detail/support_ties.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// The pieces of what lies beyond the free borders of an object that the window spans, parted by what is held.
struct FreePieces {
    static constexpr int kNone = -1;

    /// Piece of each node; kNone: it lies on the sheet, is held, away from the border, or in a gap between points.
    std::vector<int> of;
    int              count   = 0;
    int              leftOut = 0; ///< pieces farther away, which count as the first, and HeldInPlane::without
};

/// Finds them: first the largest around each part of the sheet, as one, and then the others as they are near the touch.
[[nodiscard]] FreePieces freePieces(const Patch& patch, const HeldInPlane& held);

/// Returns the fields by which Airy's function is another linear function at each piece, three for each but the first:
/// 1, and the places along x and z over a quarter of the window, from its middle; 0 at the others, and smooth between
/// them, by inverse squares of the distances.
/// \pre the patch has its bed of stresses
[[nodiscard]] std::vector<NodeField> thrustFields(const Patch& patch, const FreePieces& pieces);

} // namespace palp
