// tail_level.h - the coarse levels that plate_tail.comp does in one dispatch (GLSL and C++).
#ifndef PALPATE_TAIL_LEVEL_H
#define PALPATE_TAIL_LEVEL_H

#include "compute_shaders/shared/plate_level.h"

#ifdef __cplusplus
namespace palp::shared {
#endif

// The sizes of the kernel's shared arrays and loops: levels of 64, 32 and 16 cells per side.
const int kTailPool   = 8000;    // numbers in shared memory, 32 kB
const int kTailNodes  = 65 * 65; // of a level
const int kTailHalf   = 65 * 33; // nodes of one colour of a level, counted as columns times half rows rounded up
const int kTailLevels = 8;

// Positions are those of the first number of this level in arrays that hold all levels of the tail.
struct TailLevel {
    PlateLevel plate;
    int        field;  // in rigidity, divisor and (per load) the deflections put aside
    int        tableX; // in the transfer tables, those to the next coarser level
    int        tableZ;
    int        w;     // in shared memory: deflection
    int        force; // in shared memory; the first level's force is not there
};

struct TailPush {
    uint first;  // level to begin with; the last one is solved at once
    uint levels; // of the tail
    uint nodes;  // numbers of all of them together, what lies between them included
};

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
