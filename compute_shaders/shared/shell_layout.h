// shell_layout.h - how the two fields of a shell and its coefficients lie in memory (GLSL and C++).
//
// Rows of x follow one another with kShellRim empty ones to either side; in a row the nodes with an even index along z
// stand before those with an odd one, and behind both at least one empty place up to a multiple of eight. Nodes of one
// colour are neighbours in memory, and no stencil has to look where it is.
//
//   fields        [load][row][w, phi][even, odd][span]
//   coefficients  [row][plane][even, odd][span]
//
// A row of the matrix is written in changes from the node,
//
//   (A w)(n) = sum over the twelve neighbours m of a(n, m) (w(m) - w(n)) + bed(n) w(n)
//
// because a row without its bed adds up to nothing, also towards held nodes, whose value is 0: what rounding does to an
// entry is then relative to the slope and not to the deflection. An entry that two nodes share is kept at the first
// one.
#ifndef PALPATE_SHELL_LAYOUT_H
#define PALPATE_SHELL_LAYOUT_H

#ifdef __cplusplus
#include <cstdint>
namespace palp::shared {
using uint = std::uint32_t;
#define PALPATE_PLANE(name, number) name = number,
enum ShellPlane : int {
#else
#define PALPATE_PLANE(name, number) const int name = number;
#endif
PALPATE_PLANE(kBendEast, 0) // of A, towards the next node along x; along z it is north
PALPATE_PLANE(kBendNorth, 1)
PALPATE_PLANE(kBendEast2, 2) // two nodes away
PALPATE_PLANE(kBendNorth2, 3)
PALPATE_PLANE(kBendNorthEast, 4)
PALPATE_PLANE(kBendSouthEast, 5)
PALPATE_PLANE(kStressEast, 6) // of C, as of A
PALPATE_PLANE(kStressNorth, 7)
PALPATE_PLANE(kStressEast2, 8)
PALPATE_PLANE(kStressNorth2, 9)
PALPATE_PLANE(kStressNorthEast, 10)
PALPATE_PLANE(kStressSouthEast, 11)
PALPATE_PLANE(kCoupleEast, 12) // of B, the row of w, towards each of eight neighbours
PALPATE_PLANE(kCoupleWest, 13)
PALPATE_PLANE(kCoupleNorth, 14)
PALPATE_PLANE(kCoupleSouth, 15)
PALPATE_PLANE(kCoupleNorthEast, 16)
PALPATE_PLANE(kCoupleNorthWest, 17)
PALPATE_PLANE(kCoupleSouthEast, 18)
PALPATE_PLANE(kCoupleSouthWest, 19)
PALPATE_PLANE(kBed, 20)       // what the foundation adds to the row of w
PALPATE_PLANE(kStressBed, 21) // what phi's bed adds to the row of C
PALPATE_PLANE(kColumnSum, 22) // of B: what a deflection of 1 everywhere does to the row of phi
PALPATE_PLANE(kInverseW, 23)  // what relaxation multiplies the residuals of the node with: see shell_relax.h
PALPATE_PLANE(kInverseWF, 24)
PALPATE_PLANE(kInverseF, 25)
PALPATE_PLANE(kShellPlanes, 26)
#ifdef __cplusplus
};
#endif
#undef PALPATE_PLANE

const int kShellRim = 2;

struct ShellLayout {
    int cellsX;
    int cellsZ;
    int span; // places of the nodes of a row with an even index

#ifdef __cplusplus
    friend bool operator==(const ShellLayout&, const ShellLayout&) = default;
#endif
};

// Push constants of the passes over fields.
struct ShellPassPush {
    ShellLayout fine;
    ShellLayout coarse;   // for transfers alone
    int         colour;   // whose nodes are relaxed
    uint        fromZero; // 1: a correction is put, not added
};

// Of the coarsest level's factors.
struct ShellBandPush {
    uint unknowns;
    uint halfBand;
    uint numbers; // of a field of one load
};

// Of passes over vectors.
struct ShellVectorPush {
    uint numbers; // of one load, a multiple of eight
    uint loads;
    uint slot; // which of the sums
};

// Sums over a vector: it is cut into kShellParts, a part is summed in eight lanes, and lanes are added part by part.
const uint kShellLanes = 8u;
const uint kShellParts = 64u;

// The numbers in each part but the last ones, which may be shorter.
#ifdef __cplusplus
inline
#endif
    uint
    shellPart(uint numbers)
{
    uint rows = (numbers / kShellLanes + kShellParts - 1u) / kShellParts;
    return rows * kShellLanes;
}

// The most unknowns of the coarsest level that a workgroup takes, with the empty ones behind them.
const uint kMostShellUnknowns = 1024u;

// Numbers of the columns of its factor that a workgroup keeps together: room for two columns at least, because one has
// fewer than kMostShellUnknowns.
const uint kShellTogether = 2048u;

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
