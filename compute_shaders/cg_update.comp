// cg_update.comp - a step of conjugate gradients, x += alpha p and r -= alpha A p.
// Domain     x: one invocation per node; z: loads
// Reads      alpha and number of steps (real), direction p and its forces q = A p (real)
// Writes     answer x, residual r (real; each invocation its own number), the residual rounded for the cycle (float)
//
// Does nothing if the solve stopped before step push.iteration.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/cg_state.h"

layout(push_constant) uniform Constants { VectorPush push; };
layout(std430, binding = 0) readonly buffer State { real state[]; };
layout(std430, binding = 1) readonly buffer Direction { real p[]; };
layout(std430, binding = 2) readonly buffer Forces { real q[]; };
layout(std430, binding = 3) buffer Answer { real x[]; };
layout(std430, binding = 4) buffer Residual { real r[]; };
layout(std430, binding = 5) writeonly buffer Rounded { float rounded[]; };

void main()
{
    uint n = gl_GlobalInvocationID.x;
    int  at = int(gl_GlobalInvocationID.z) * kStateWords;
    if (n >= push.nodes || state[at + kStateSteps] != real(float(push.iteration))) return;
    real alpha = state[at + kStateAlpha];
    n += gl_GlobalInvocationID.z * push.nodes;
    x[n] += alpha * p[n];
    real left = r[n] - alpha * q[n];
    r[n] = left;
    rounded[n] = float(left);
}
