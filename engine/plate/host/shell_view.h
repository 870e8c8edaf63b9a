#pragma once
#include <cstddef>

#include "compute_shaders/shared/plate_level.h"

namespace palp {

/// The coefficients of a node of a shell's level, each a plane of numbers. A x is written in changes from the node,
///
///     (A w)(n) = sum over the twelve neighbours m of a(n, m) (w(m) - w(n)) + bed(n) w(n)
///
/// because a row without its bed adds up to nothing, also towards held nodes, whose value is 0: what rounding does to an
/// entry is then relative to the slope and not to the deflection. An entry that two nodes share is kept at the first one.
enum ShellPlane : int {
    kBendEast, ///< of A, towards the next node along x; along z it is north
    kBendNorth,
    kBendEast2, ///< two nodes away
    kBendNorth2,
    kBendNorthEast,
    kBendSouthEast,
    kStressEast, ///< of C, as of A
    kStressNorth,
    kStressEast2,
    kStressNorth2,
    kStressNorthEast,
    kStressSouthEast,
    kCoupleEast, ///< of B, the row of w, towards each of eight neighbours
    kCoupleWest,
    kCoupleNorth,
    kCoupleSouth,
    kCoupleNorthEast,
    kCoupleNorthWest,
    kCoupleSouthEast,
    kCoupleSouthWest,
    kBed,       ///< what the foundation adds to the row of w
    kColumnSum, ///< of B: what a deflection of 1 everywhere does to the row of phi
    kInverseW,  ///< what relaxation multiplies the residuals of the node with: see compute_shaders/shared/shell_relax.h
    kInverseWF,
    kInverseF,
    kShellPlanes
};

/// How nodes lie in memory: rows of x one after the other with two empty ones to either side, in a row the nodes with an
/// even index along z before those with an odd one, and behind both at least one empty place up to a multiple of eight.
/// Nodes of one colour are neighbours in memory, and no stencil has to look where it is.
///
///     fields        [row][w, phi][even, odd][span][load]
///     coefficients  [row][plane][even, odd][span]
struct ShellLayout {
    int cellsX, cellsZ;
    int span; ///< places of the nodes of a row with an even index

    friend bool operator==(const ShellLayout&, const ShellLayout&) = default;
};

inline constexpr int kShellRim = 2; ///< empty rows before the first and behind the last

/// One level's maps as the host's kernels see them, the last index along z fastest.
struct ShellMaps {
    shared::PlateLevel bending, stress;
    const float *      rigidity, *compliance;                 ///< over their means [1]
    const float*       shape;                                 ///< of the foundation; null: 1
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

/// Sizes of vectors, for sums over all nodes.
struct VectorSize {
    std::ptrdiff_t numbers; ///< of one load, a multiple of eight
};

} // namespace palp
