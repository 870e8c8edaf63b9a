#pragma once
#include <cstddef>

#include "compute_shaders/shared/plate_level.h"
#include "compute_shaders/shared/shell_layout.h"
#include "engine/plate/host/rim_view.h"

namespace palp {

using shared::kShellRim;
using shared::ShellLayout;
using enum shared::ShellPlane;

/// One level's maps as the host's kernels see them, the last index along z fastest.
struct ShellMaps {
    shared::PlateLevel bending, stress;
    const float *      rigidity, *compliance;                 ///< over their means [1]
    const float*       shape;                                 ///< of the foundation; null: 1
    const float*       stressShape;                           ///< of phi's bed; null: there is none
    const float *      curvatureX, *curvatureZ, *curvatureXZ; ///< times what makes them entries [1]
};

/// What kernels of shells are pushed.
struct ShellPush {
    ShellLayout layout{}, coarse{}; ///< the second one for transfers alone
    int         colour     = 0;     ///< whose nodes are relaxed first
    int         halfSweeps = 0;
    bool        fromZero   = false; ///< the fields are 0 before, whatever is in memory
    bool        toDoubles  = false; ///< coefficients are wanted in doubles
};

/// A matrix of a band for L D L' without pivots: at [column * (halfBand + 1) + below].
struct BandPush {
    int                   unknowns, halfBand;
    const std::ptrdiff_t* places; ///< of the unknowns in a field of one load
};

/// The fronts of a symmetric matrix, as the host's kernels see them. Unknowns are numbered in the order of elimination.
struct ShellFronts {
    const RimFront*       fronts; ///< a front has as many rows as border and own unknowns, in whole vectors
    const int*            borders;
    int                   frontCount, unknowns, mostRows;
    const std::ptrdiff_t* starts; ///< of each unknown's column in the two lists of entries, the diagonal first
    const int*            rows;   ///< unknowns, no earlier than the column's
    const double*         values;
    const double*         signs;   ///< that pivots must have: 1 or -1, by unknown
    double*               columns; ///< of the factor: a front's own unknowns, then its border, 1 / L on the diagonal
};

/// Sizes of vectors, for sums over all nodes.
struct VectorSize {
    std::ptrdiff_t numbers; ///< of one load, a multiple of eight
};

} // namespace palp
