// plate_level.h - one level of the grid hierarchy, an input of every kernel of the plate (GLSL and C++).
#ifndef PALPATE_PLATE_LEVEL_H
#define PALPATE_PLATE_LEVEL_H

#ifdef __cplusplus
#include <cstdint>
#define PALPATE_INLINE inline
namespace palp::shared {
using uint = std::uint32_t;
#else
#define PALPATE_INLINE
#endif

// Sides of a plate, as bits.
const uint kSideX0 = 1u;
const uint kSideX1 = 2u;
const uint kSideZ0 = 4u;
const uint kSideZ1 = 8u;

// Deflection is measured in units in which the finest grid has stiffness D0/(hx hz) = 1, so every number below is of
// order one whatever the units of the plate. With a = hx hz of this level over that of the finest one:
struct PlateLevel {
    int   cellsX;
    int   cellsZ;
    uint  hinged; // sides without bending moment: supported and free
    uint  free;   // sides whose nodes move: free and guided
    float kxx;    // hz^2/hx^2 / a          of the moment along x per second difference along x [1]
    float kzz;    // hx^2/hz^2 / a
    float kxz;    // nu / a
    float exx;    // (1 - nu^2)/2 kxx       on a side along which the other moment is condensed out
    float ezz;    // (1 - nu^2)/2 kzz
    float twist;  // (1 - nu)/2 / a         per sum of the four rigidities around a cell
    float bed;     // foundation k hx^2 hz^2 / D0 of the finest grid, times a [1]
    int   shapeAt; // 0: the foundation is k at every node; else it is k times a number, which lies this far behind the
                   // node's rigidity in the buffer of rigidities
};

#ifdef __cplusplus
}
#endif
#endif
