// cg_dot.comp - partial sums of the dot products of conjugate gradients, in a fixed order.
// Domain     x: one invocation per partial sum t, which adds the terms t, t + partials, ...; z: loads
// Reads      with PALPATE_STEP: direction p (real), forces A p (real); without: residual r (real), preconditioned
//            residual z (float), answer x (real), load f (float)
// Writes     partial sums (real): with PALPATE_STEP of (p, A p); without of (r, z), then of (f, x)
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { VectorPush push; };
#ifdef PALPATE_STEP
layout(std430, binding = 0) readonly buffer Direction { real p[]; };
layout(std430, binding = 1) readonly buffer Forces { real q[]; };
layout(std430, binding = 2) writeonly buffer Partials { real partials[]; };
#else
layout(std430, binding = 0) readonly buffer Residual { real r[]; };
layout(std430, binding = 1) readonly buffer Preconditioned { float z[]; };
layout(std430, binding = 2) readonly buffer Answer { real x[]; };
layout(std430, binding = 3) readonly buffer Load { float f[]; };
layout(std430, binding = 4) writeonly buffer Partials { real partials[]; };
#endif

void main()
{
    uint t = gl_GlobalInvocationID.x, load = gl_GlobalInvocationID.z;
    if (t >= push.partials) return;
    uint base = load * push.nodes;
#ifdef PALPATE_STEP
    real sum = real(0.0f);
    for (uint n = t; n < push.nodes; n += push.partials) sum += p[base + n] * q[base + n];
    partials[load * push.partials + t] = sum;
#else
    real rz = real(0.0f), fx = real(0.0f);
    for (uint n = t; n < push.nodes; n += push.partials) {
        rz += r[base + n] * real(z[base + n]);
        fx += real(f[base + n]) * x[base + n];
    }
    partials[2u * load * push.partials + t] = rz;
    partials[(2u * load + 1u) * push.partials + t] = fx;
#endif
}
