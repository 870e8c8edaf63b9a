// cg_finish.comp - the update of the last step that a list of fused steps took, wherever its numbers are.
// Domain     x: one invocation per node; z: loads
// Reads      alpha and number of steps (real), both directions and the forces q = A p of the last one, both residuals
// (real) Writes     answer x, the first residual, the first direction (real; each invocation its own number), with
// which the next
//            list begins; the residual rounded for the cycle (float)
//
// Of an odd number of steps the last one had the second direction and the first residual, of an even one the others.
// The steps before it were updated on the way down of the next one's cycle, see plate_down.comp.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/cg_state.h"

layout(push_constant) uniform Constants { VectorPush push; };
layout(std430, binding = 0) readonly buffer State { real state[]; };
layout(std430, binding = 1) buffer Direction { real p[]; };
layout(std430, binding = 2) readonly buffer OtherDirection { real otherP[]; };
layout(std430, binding = 3) readonly buffer Forces { real q[]; };
layout(std430, binding = 4) buffer Answer { real x[]; };
layout(std430, binding = 5) buffer Residual { real r[]; };
layout(std430, binding = 6) readonly buffer OtherResidual { real otherR[]; };
layout(std430, binding = 7) writeonly buffer Rounded { float rounded[]; };

void main()
{
    uint n = gl_GlobalInvocationID.x;
    int  at = int(gl_GlobalInvocationID.z) * kStateWords;
    if (n >= push.nodes) return;
    real alpha = state[at + kStateAlpha];
    bool odd   = (uint(state[at + kStateSteps]) & 1u) == 1u;
    n += gl_GlobalInvocationID.z * push.nodes;
    real last = odd ? otherP[n] : p[n];
    p[n] = last;
    x[n] += alpha * last;
    real left = (odd ? r[n] : otherR[n]) - alpha * q[n];
    r[n] = left;
    rounded[n] = float(left);
}
