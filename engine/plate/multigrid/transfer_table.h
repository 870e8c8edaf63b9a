#pragma once
#include <vector>

#include "engine/plate/plate.h"

namespace palp {

/// Cubic interpolation from a coarse to a fine grid along one axis, and its transpose, as the shaders read them: the
/// layout is in compute_shaders/shared/transfer_layout.h.
///
/// A fine node takes the four coarse nodes around it; where one of them lies beyond a side it is what the side makes of
/// it: that of x^2 (a + b x) through the next two (clamped), the negative (supported) or the linear extrapolation
/// (free). Held nodes give and get nothing. Equal numbers of cells give the identity; a fine grid need not have twice
/// the cells of the coarse one. \param fineCells, coarseCells  fineCells/2 <= coarseCells <= fineCells, coarseCells >=
/// 3
[[nodiscard]] std::vector<float> transferTable(int fineCells, int coarseCells, Edge first, Edge last);

} // namespace palp
