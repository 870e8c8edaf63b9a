// shell_dots.comp - the sum of the products of two vectors, of each load, in doubles.
// Domain     one workgroup per load
// Reads      two vectors; with PALPATE_OF_CYCLE the second one is of floats
// Writes     the sum of each load in the push's slot
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellVectorPush push; };
layout(std430, binding = 0) readonly buffer First { double a[]; };
#ifdef PALPATE_OF_CYCLE
layout(std430, binding = 1) readonly buffer Second { float b[]; };
#else
layout(std430, binding = 1) readonly buffer Second { double b[]; };
#endif
layout(std430, binding = 2) buffer Sums { double sums[]; };

shared double parts[kShellParts * kShellLanes];

void main()
{
    uint lane = gl_LocalInvocationID.x, lanes = gl_WorkGroupSize.x, base = gl_WorkGroupID.z * push.numbers;
    uint part = shellPart(push.numbers);
    for (uint p = lane; p < kShellParts * kShellLanes; p += lanes) {
        uint   first = p / kShellLanes * part, end = min(first + part, push.numbers);
        double sum   = 0.0;
        for (uint n = first + p % kShellLanes; n < end; n += kShellLanes) sum += a[base + n] * double(b[base + n]);
        parts[p] = sum;
    }
    barrier();
    for (uint k = lane; k < kShellLanes; k += lanes) {
        double sum = 0.0;
        for (uint p = 0u; p < kShellParts; ++p) sum += parts[p * kShellLanes + k];
        parts[k] = sum;
    }
    barrier();
    if (lane != 0u) return;
    double sum = 0.0;
    for (uint k = 0u; k < kShellLanes; ++k) sum += parts[k];
    sums[push.slot * push.loads + gl_WorkGroupID.z] = sum;
}
