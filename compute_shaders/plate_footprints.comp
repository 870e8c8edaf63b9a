// plate_footprints.comp - what each load feels of its own deflection, from an answer that is only nearly right.
//
// The compliance (f, x) is wrong by the answer's error e, in the first order. With the residual r = f - A x that
// conjugate gradients have anyway, (f, x) + (r, x) = (f, A^-1 f) - (e, A e): the error is the square of the one in
// energy.
//
// Domain     z: loads; one workgroup each, of a power of two of invocations
// Reads      residual r (real), answer x (real), footprints (see shared/footprint_layout.h)
// Writes     responses (real): (f + r, x), and the works of the changes
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/footprint_layout.h"

layout(push_constant) uniform Constants { VectorPush push; };
layout(std430, binding = 0) readonly buffer Residual { real r[]; };
layout(std430, binding = 1) readonly buffer Answer { real x[]; };
layout(std430, binding = 2) readonly buffer Footprints { uint words[]; };
layout(std430, binding = 3) writeonly buffer Responses { real responses[]; };

const int kMostInvocations = 256; // of this workgroup
shared real sums[kResponseWords][kMostInvocations];

void main()
{
    uint load = gl_WorkGroupID.z, t = gl_LocalInvocationID.x, width = gl_WorkGroupSize.x, base = load * push.nodes;
    real work = real(0.0f), changeX = real(0.0f), changeZ = real(0.0f);
    for (uint n = t; n < push.nodes; n += width) work += r[base + n] * x[base + n];
    uint first = words[load * kFootprintHead], count = words[load * kFootprintHead + 1u];
    for (uint k = t; k < count; k += width) {
        uint at = first + k * kPartWords;
        real w = x[base + words[at]];
        work += real(uintBitsToFloat(words[at + 1u])) * w;
        changeX += real(uintBitsToFloat(words[at + 2u])) * w;
        changeZ += real(uintBitsToFloat(words[at + 3u])) * w;
    }
    sums[kResponseWork][t]    = work;
    sums[kResponseChangeX][t] = changeX;
    sums[kResponseChangeZ][t] = changeZ;
    for (uint step = width / 2u; step > 0u; step /= 2u) {
        barrier();
        if (t < step)
            for (int n = 0; n < kResponseWords; ++n) sums[n][t] += sums[n][t + step];
    }
    barrier();
    if (t < uint(kResponseWords)) responses[load * kResponseWords + t] = sums[t][0];
}
