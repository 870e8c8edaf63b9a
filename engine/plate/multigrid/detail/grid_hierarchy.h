#pragma once
#include <cstddef>
#include <vector>

#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/plate_level.h"
#include "engine/plate/plate.h"

namespace palp {

/// Counts the nodes of one load.
[[nodiscard]] inline std::size_t nodesOf(const shared::PlateLevel& g) noexcept
{
    return std::size_t(g.cellsX + 1) * std::size_t(g.cellsZ + 1);
}

/// A grid and coarser and coarser ones over the same rectangle, with the multigrid kernels' data of each.
///
/// A step halves the cells along both axes (rounding up), until no side has more than `coarsest` cells. An axis is not
/// halved while its spacing is 1.5 times the other's or more, because point relaxation does not smooth along it, or
/// when it has only 4 to 7 cells.
struct GridHierarchy {
    struct Level {
        shared::PlateLevel plate;          ///< spacing, sides, scaled coefficients
        std::vector<float> tableX, tableZ; ///< to the next coarser level, see transfer_table.h; empty on the coarsest
    };
    std::vector<Level> levels; ///< finest first

    /// Energy unit of the finest level per squared deflection: a deflection is force/stiffness times the number that
    /// the kernels compute from rigidity/unitRigidity and force 1 [N/m].
    double stiffness = 0;
};

/// \param plate         its rigidity is not read
/// \param unitRigidity  D0 [N m] that the kernels' rigidity is relative to, > 0
/// \param coarsest      cells along a side of the coarsest level, 8 to kMostCoarseCells
[[nodiscard]] GridHierarchy gridHierarchy(const Plate& plate, double unitRigidity,
                                          int coarsest = shared::kMostCoarseCells);

} // namespace palp
