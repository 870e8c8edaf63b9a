// cg_direction.comp - next direction of conjugate gradients, p = z + beta p.
// Domain     x: one invocation per node; z: loads
// Reads      preconditioned residual z (float), last direction (real), beta (real)
// Writes     direction (real), over the last one: each invocation reads and writes only its own number
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/cg_state.h"

layout(push_constant) uniform Constants { VectorPush push; };
layout(std430, binding = 0) readonly buffer State { real state[]; };
layout(std430, binding = 1) readonly buffer Preconditioned { float z[]; };
layout(std430, binding = 2) buffer Direction { real p[]; };

void main()
{
    uint load = gl_GlobalInvocationID.z, n = gl_GlobalInvocationID.x;
    if (n >= push.nodes) return;
    real beta = state[int(load) * kStateWords + kStateBeta];
    n += load * push.nodes;
    p[n] = beta == real(0.0f) ? real(z[n]) : real(z[n]) + beta * p[n]; // before the first direction, p holds undefined memory
}
