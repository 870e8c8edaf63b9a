// rigidity_level.h - the levels as kernels read them that prepare all of them in one dispatch (GLSL and C++).
#ifndef PALPATE_RIGIDITY_LEVEL_H
#define PALPATE_RIGIDITY_LEVEL_H

#include "compute_shaders/shared/plate_level.h"

#ifdef __cplusplus
namespace palp::shared {
#endif

// Positions are those of the first number of this level in arrays that hold all levels, finest first.
struct RigidityLevel {
    PlateLevel plate;
    int        field;   // in rigidity and divisor
    int        list;    // in marks and lists of tiles
    int        row;     // rows of nodes of the finer levels together
    int        tileRow; // rows of tiles of the finer levels together
};

struct RigidityPush {
    uint levels;
    uint rows; // of nodes, of all levels but the coarsest
};

// A workgroup of rigidity_levels.comp makes kOwnNodes x kOwnNodes nodes of the level kDeep levels below the finest one,
// and what they are made of on the levels between.
const int kDeep     = 3;
const int kOwnNodes = 4;
const int kMidNodes = 2 * kOwnNodes + 1; // along either side on the next finer level: two per node, and both neighbours
const int kTopNodes = 2 * kMidNodes + 1;

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
