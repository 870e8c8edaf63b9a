// point_layout.h - points scattered over a plate's grid, sorted into buckets (GLSL and C++).
//
// Positions count spacings from node (0, 0), so that nodes are whole numbers. Buckets are squares in these units whose
// side is a power of two and whose edges are multiples of it: no device rounds them, so a bucket's edges bound its
// points exactly. They cover the points' bounding box, but at most the grid and half its size around it:
//
//     bucket (a, b) is number n = a bucketsZ + b and holds the points starts[n] ... starts[n + 1] - 1
//     its points have  (firstX + a) side <= x < (firstX + a + 1) side;  the outermost ones also hold what lies beyond
//
// A row of buckets is thus one run of points. The layout is read from a buffer, not pushed: the numbers of points and
// buckets change from contact to contact, and lists that are recorded once go on working.
#ifndef PALPATE_POINT_LAYOUT_H
#define PALPATE_POINT_LAYOUT_H

#ifdef __cplusplus
#include <cstdint>
namespace palp::shared {
using uint = std::uint32_t;
#endif

struct ScatteredPoint {
    float x;         // [spacings]
    float z;         // [spacings]
    float rigidity;  // of the unit [1]
    float logarithm; // of that [1]
    uint  number;    // as the host counts
};

struct PointLayout {
    int   cellsX;   // of the grid [1]
    int   cellsZ;   // [1]
    uint  points;   // [1]
    int   bucketsX; // at least 1
    int   bucketsZ;
    int   firstX;  // of the first bucket's edge [sides]
    int   firstZ;  // [sides]
    float side;    // of a bucket, a power of two [spacings]
    float perSide; // its inverse: products with it are exact, which quotients need not be [1/spacings]
    float scaleX;  // spacing along x over the larger one, the unit of distances [1]
    float scaleZ;  // [1]
    float reachX;  // of the log-mean, 4 s [spacings]
    float reachZ;  // [spacings]
    float falloff; // -1 / (2 s^2) [1 / larger spacing^2]
    float nearby2; // a node without a point within 2.5 s counts: that, squared [larger spacing^2]
};

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
