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

#include "compute_shaders/coarse_factor.glsl"

void main()
{
    uint lost = factorBand(push.level);
    if (gl_LocalInvocationIndex == 0u) lostPivots[0] = lost;
}
