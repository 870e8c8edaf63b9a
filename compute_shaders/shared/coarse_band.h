// coarse_band.h - how the coarsest level's matrix is laid out (GLSL and C++).
//
// Unknowns are the nodes, held ones included with the row of the identity, numbered along the shorter side first: the
// operator reaches two columns, so that the half band is twice the shorter side. Column n of the lower triangle is
// entries (n, n), (n + 1, n), ... (n + halfBand, n), stored one after the other.
#ifndef PALPATE_COARSE_BAND_H
#define PALPATE_COARSE_BAND_H

#include "compute_shaders/shared/plate_level.h"

#ifdef __cplusplus
#include <cmath>
namespace palp::shared {
#define PALPATE_PRECISE
#else
#define PALPATE_PRECISE precise
#endif

const int kMostCoarseCells = 16; // along either side; the kernels' shared arrays are made for it
const int kMostCoarseNodes = (kMostCoarseCells + 1) * (kMostCoarseCells + 1);
const int kMostHalfBand    = 2 * (kMostCoarseCells + 1);
const int kColumnsTogether = 32; // of the factor, in shared memory where the inverse is made; a multiple of the block

// A pivot of at most this share of the diagonal is rounding, perhaps negative. Its node is then held, by an inverse of
// 0, which keeps the factor finite and the solve symmetric; but the motion with that node is lost to the solver, which
// must report it. In floats a plate that only a soft foundation holds has such pivots, or one that a soft strip holds;
// in doubles only contrasts of 1e12 and more.
//
// In floats rounding may as well leave such a motion a pivot of some 1e-5 by chance, and then the answer is wrong by as
// much as it likes and seems to be right (a free plate on 1e-6 Pa/m by 7 %). So pivots up to kDoubtfulPivot are
// reported, too, though they are used: those of a plate of 1 N m and 1 m that lies free on 0.5 Pa/m, or of a disc of
// 400.
const float kLeastPivot       = 1e-7f;  // [1]
const float kDoubtfulPivot    = 1e-4f;  // [1]
const float kLeastPivotDouble = 1e-15f; // [1]

PALPATE_INLINE bool zIsShorter(PlateLevel g) { return g.cellsZ <= g.cellsX; }
PALPATE_INLINE int  shorterNodes(PlateLevel g) { return (zIsShorter(g) ? g.cellsZ : g.cellsX) + 1; }
PALPATE_INLINE int  halfBand(PlateLevel g) { return 2 * shorterNodes(g); }
PALPATE_INLINE int  columnOf(PlateLevel g, int unknown)
{
    return zIsShorter(g) ? unknown / shorterNodes(g) : unknown % shorterNodes(g);
}
PALPATE_INLINE int rowOf(PlateLevel g, int unknown)
{
    return zIsShorter(g) ? unknown % shorterNodes(g) : unknown / shorterNodes(g);
}

// 1 / sqrt(x), the inverse of the factor's diagonal. That of a double comes from a float's by two steps of Newton's
// method, each of which doubles the digits, for which all columns of the factor wait one after the other. Pivots are of
// order one; those that a float does not hold are taken as they are.
PALPATE_INLINE float inverseRoot(float x)
{
#ifdef __cplusplus
    using std::sqrt;
#endif
    PALPATE_PRECISE float root = sqrt(x), inverse = 1.0f / root;
    return inverse;
}
#if defined(__cplusplus) || defined(PALPATE_DOUBLE)
PALPATE_INLINE double inverseRoot(double x)
{
#ifdef __cplusplus
    using std::sqrt;
#endif
    if (!(x > double(1e-30f) && x < double(1e30f))) {
        PALPATE_PRECISE double root = sqrt(x), inverse = double(1.0f) / root;
        return inverse;
    }
    PALPATE_PRECISE double once  = double(inverseRoot(float(x)));
    PALPATE_PRECISE double twice = once + once * (double(0.5f) - double(0.5f) * x * once * once);
    PALPATE_PRECISE double thrice = twice + twice * (double(0.5f) - double(0.5f) * x * twice * twice);
    return thrice;
}
#endif

#undef PALPATE_PRECISE
#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
