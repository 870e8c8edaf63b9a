// shell_by_inverse.comp - both fields of a shell's coarsest level, by the inverse of its matrix.
// Domain     x: one workgroup, of a power of two of invocations, per unknown; z: loads
// Reads      the inverse, which is symmetric, row after row (double), places of the unknowns in a field, right side
// Writes     fields
//
// Substitution by the factors waits for every unknown in turn, with all but one multiprocessor idle: 0.4 ms for 450 of
// them, where all other passes of a step together take 0.2. A product has nothing to wait for.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellBandPush push; };
layout(std430, binding = 0) readonly buffer Inverse { double inverse[]; };
layout(std430, binding = 1) readonly buffer Places { int places[]; };
layout(std430, binding = 2) readonly buffer Right { float b[]; };
layout(std430, binding = 3) writeonly buffer Fields { float x[]; };

shared double sums[gl_WorkGroupSize.x];

uint at(uint u) { return gl_WorkGroupID.z * push.numbers + uint(places[u]); }

void main()
{
    uint   lane = gl_LocalInvocationID.x, row = gl_WorkGroupID.x;
    double sum  = 0.0;
    for (uint u = lane; u < push.unknowns; u += gl_WorkGroupSize.x)
        sum += inverse[row * push.unknowns + u] * double(b[at(u)]);
    sums[lane] = sum;
    for (uint reach = gl_WorkGroupSize.x / 2u; reach > 0u; reach /= 2u) {
        barrier();
        if (lane < reach) sums[lane] += sums[lane + reach];
    }
    if (lane == 0u) x[at(row)] = float(sums[0]);
}
