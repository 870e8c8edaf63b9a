#pragma once
#include <vector>

#include "engine/plate/plate.h"

namespace palp {

/// Makes the table of cubic interpolation from a coarse to a fine grid along one axis, and of its transpose, as the
/// kernels read it: compute_shaders/shared/transfer_layout.h has the layout.
///
/// A fine node takes the four coarse nodes around it. Where one of them lies beyond a side, the side decides its value:
/// that of x^2 (a + b x) through the next two nodes (clamped), the negative (supported) or the linear extrapolation
/// (free). Held nodes have no weights. Equal numbers of cells give the identity; a fine grid need not have
/// twice the cells of the coarse one.
/// \param fineCells, coarseCells  fineCells/2 <= coarseCells <= fineCells, coarseCells >= 3
[[nodiscard]] std::vector<float> transferTable(int fineCells, int coarseCells, Edge first, Edge last);

} // namespace palp
