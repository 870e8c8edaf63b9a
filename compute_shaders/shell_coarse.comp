// shell_coarse.comp - both fields of a shell's coarsest level, by the factors L D L' of its band.
// Domain     one workgroup per load
// Reads      columns of L with the inverse pivot first (double), places of the unknowns in a field, right side
// Writes     fields
//
// In the order of the host's kernel: from below a product with a column is summed in eight lanes, whose sums are added to
// that of the rest.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellBandPush push; };
layout(std430, binding = 0) readonly buffer Factors { double factors[]; };
layout(std430, binding = 1) readonly buffer Places { int places[]; };
layout(std430, binding = 2) readonly buffer Right { float b[]; };
layout(std430, binding = 3) writeonly buffer Fields { float x[]; };

shared double y[kMostShellUnknowns];
shared double sums[kShellLanes];

void main()
{
    uint lane = gl_LocalInvocationID.x, lanes = gl_WorkGroupSize.x;
    uint band = push.halfBand, stride = band + 1u, base = gl_WorkGroupID.z * push.numbers;
    for (uint u = lane; u < kMostShellUnknowns; u += lanes) y[u] = u < push.unknowns ? double(b[base + places[u]]) : 0.0;
    barrier();
    for (uint c = 0u; c < push.unknowns; ++c) {
        double first = y[c];
        for (uint m = 1u + lane; m <= band; m += lanes) y[c + m] -= factors[c * stride + m] * first;
        barrier();
    }
    uint whole = band / kShellLanes * kShellLanes;
    for (uint n = 0u; n < push.unknowns; ++n) {
        uint c = push.unknowns - 1u - n, at = c * stride;
        for (uint k = lane; k < kShellLanes; k += lanes) {
            double sum = 0.0;
            for (uint m = 1u + k; m <= whole; m += kShellLanes) sum += factors[at + m] * y[c + m];
            sums[k] = sum;
        }
        barrier();
        if (lane == 0u) {
            double sum = 0.0;
            for (uint m = whole + 1u; m <= band; ++m) sum += factors[at + m] * y[c + m];
            for (uint k = 0u; k < kShellLanes; ++k) sum += sums[k];
            y[c] = factors[at] * y[c] - sum;
        }
        barrier();
    }
    for (uint u = lane; u < push.unknowns; u += lanes) x[base + places[u]] = float(y[u]);
}
