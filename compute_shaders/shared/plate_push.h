// plate_push.h - push constants of the plate's kernels, at most 128 bytes each (GLSL and C++).
//
// 32-bit scalars only, so that C++ and GLSL lay them out alike; a test has a shader echo every field.
#ifndef PALPATE_PLATE_PUSH_H
#define PALPATE_PLATE_PUSH_H

#include "compute_shaders/shared/plate_level.h"

#ifdef __cplusplus
namespace palp::shared {
#endif

struct LevelPush {
    PlateLevel level;
};

const int kEntries = 9; // of a row of the operator, of which a divisor is made; see plate_divisor.h

struct RelaxPush {
    PlateLevel level;
    uint       colour; // parity of i + j of the nodes to relax
};

struct SweepPush {
    PlateLevel level;
    uint       first;     // parity of i + j of the nodes that are relaxed first
    uint       tilesOnly; // 1: where the rigidity jumps; 0: everywhere
};

struct SmoothPush {
    PlateLevel level;
    float      ahead; // share of the last step that is taken again [1]; 0 in the first step
    float      step;  // of the residual over the divisor [1]
};

struct TransferPush {
    PlateLevel fine;
    PlateLevel coarse;
};

struct UpPush {
    PlateLevel fine;
    PlateLevel coarse;
    uint       begins; // as in ScalarsPush
};

struct VectorPush {
    uint nodes;     // of one load
    uint partials;  // sums that each dot product is split into
    uint iteration; // of the solve; an update is omitted if the solve stopped before it
};

struct ScalarsPush {
    uint  loads;
    uint  partials;      // per dot product
    uint  begins;        // 2: restarts without a previous direction; 1: restarts the count of steps; 0: continues
    uint  argumentWords; // of the indirect dispatches that a finished solve makes empty
    float tolerance;     // of the error estimate, relative [1]; 0 never stops
};

struct AimPush {
    uint nodes;  // of one load
    uint begins; // as in ScalarsPush
};

struct ProbePush {
    PlateLevel level;
    uint       loads;
    uint       argumentWords; // as in ScalarsPush
    float      tolerance;     // as in ScalarsPush
};

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
