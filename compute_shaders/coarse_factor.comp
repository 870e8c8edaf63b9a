// coarse_factor.comp - Cholesky factor of the coarsest level's band, A = L L'.
// Domain     one workgroup; unknown after unknown, the columns within reach updated side by side
// Reads      columns of the lower triangle of A (real)
// Writes     columns of L (real), with the inverse of the diagonal in its place, 0 where rounding has left no pivot;
//            the number of pivots that rounding has left nothing of, or nothing that can be relied on
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/coarse_band.h"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Band { real band[]; };
layout(std430, binding = 1) writeonly buffer Factor { real factor[]; };
layout(std430, binding = 2) writeonly buffer Lost { uint lostPivots[]; };

#ifdef PALPATE_DOUBLE
const real kLeast = real(kLeastPivotDouble), kDoubtful = kLeast;
#else
const real kLeast = kLeastPivot, kDoubtful = kDoubtfulPivot;
#endif

shared real window[kMostHalfBand + 1][kMostHalfBand + 1]; // column n, updated so far, at n mod (halfBand + 1)
shared real column[kMostHalfBand + 1];                    // of L

void main()
{
    int reach = halfBand(push.level), slots = reach + 1;
    int unknowns = nodesX(push.level) * nodesZ(push.level);
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    for (int n = lane; n < slots * slots; n += lanes) window[n / slots][n % slots] = n / slots < unknowns ? band[n] : real(0.0f);
    uint lost = 0u;
    for (int n = 0; n < unknowns; ++n) {
        int slot = n % slots;
        barrier();
        real pivot = window[slot][0];
        bool holds = !(pivot > kLeast * band[n * slots]);
        real inverse = holds ? real(0.0f) : real(1.0f) / sqrt(pivot);
        if (!(pivot > kDoubtful * band[n * slots])) ++lost;
        for (int d = lane; d <= reach; d += lanes) {
            column[d] = window[slot][d] * inverse;
            factor[n * slots + d] = d == 0 ? inverse : column[d];
        }
        barrier();
        for (int d = 1 + lane; d <= reach; d += lanes) { // of column n + d; this invocation's alone
            int other = (n + d) % slots;
            for (int e = d; e <= reach; ++e) window[other][e - d] -= column[d] * column[e];
        }
        // The slot of column n is free: the column that comes into reach next.
        int next = n + slots;
        for (int d = lane; d <= reach; d += lanes) window[slot][d] = next < unknowns ? band[next * slots + d] : real(0.0f);
    }
    if (lane == 0) lostPivots[0] = lost;
}
