// tail_level.h - the coarse levels that plate_tail.comp and plate_nested.comp do in one dispatch (GLSL and C++).
#ifndef PALPATE_TAIL_LEVEL_H
#define PALPATE_TAIL_LEVEL_H

#include "compute_shaders/shared/plate_level.h"

#ifdef __cplusplus
namespace palp::shared {
#endif

// The sizes of the kernel's shared arrays and loops: levels of 32, 16 and 8 cells per side, of which each of 640
// invocations has at most one node of a colour. A level of 64 takes one workgroup as long as all smaller ones together,
// and many workgroups half of that. The pool holds the levels of 32 x 32 cells that are halved along one axis first.
const int kTailPool   = 3400;    // numbers in shared memory, 14 kB
const int kTailSums   = 128;     // the same for sums, of which a workgroup has a multiple of invocations
const int kTailNodes  = 33 * 33; // of a level
const int kTailHalf   = 33 * 17; // nodes of one colour of a level, counted as columns times half rows rounded up
const int kTailLevels = 8;

const int kTailCoarseCells = 8; // along a side of the coarsest level where there is a tail

const int kNestedSweeps = 1; // before and after each correction in nested iteration

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

struct NestedPush {
    uint first; // as in TailPush
    uint levels;
    uint nodes;
    uint steps; // on the first level; one on the others
};

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
