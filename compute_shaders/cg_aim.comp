// cg_aim.comp - the dot products that begin a step of conjugate gradients, and beta, in one dispatch.
// Domain     x: workgroups of a power of two of invocations, which share the nodes of a load; z: loads
// Reads      residual r (real), preconditioned residual z (float), answer x (real), load f (float)
// Writes     sums of the workgroups (real): (r, z), (f, x); state of the load (real), see cg_state.h
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { AimPush push; };
layout(std430, binding = 0) readonly buffer Residual { real r[]; };
layout(std430, binding = 1) readonly buffer Preconditioned { float z[]; };
layout(std430, binding = 2) readonly buffer Answer { real x[]; };
layout(std430, binding = 3) readonly buffer Load { float f[]; };
layout(std430, binding = 4) coherent buffer Partials { real partials[]; };
layout(std430, binding = 5) coherent buffer Tickets { uint tickets[]; };
layout(std430, binding = 6) buffer State { real state[]; };

#include "compute_shaders/cg_aimed.glsl"

void main()
{
    uint load = gl_GlobalInvocationID.z, base = load * push.nodes;
    real rz = real(0.0f), fx = real(0.0f);
    for (uint n = gl_GlobalInvocationID.x; n < push.nodes; n += groupsOfLoad() * gl_WorkGroupSize.x) {
        rz += r[base + n] * real(z[base + n]);
        fx += real(f[base + n]) * x[base + n];
    }
    aim(load, rz, fx, push.begins);
}
