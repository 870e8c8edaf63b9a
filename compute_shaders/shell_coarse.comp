// shell_coarse.comp - both fields of a shell's coarsest level, by the factors L D L' of its band.
// Domain     one workgroup per load
// Reads      columns of L with the inverse pivot first (double), places of the unknowns in a field, right side
// Writes     fields
//
// With PALPATE_INVERTS load n is a unit at unknown n, and column n of the inverse is written (double).
//
// In the order of the host's kernel: from below a product with a column is summed in eight lanes, whose sums are added
// to that of the rest.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellBandPush push; };
layout(std430, binding = 0) readonly buffer Factors { double factors[]; };
#ifdef PALPATE_INVERTS
layout(std430, binding = 1) writeonly buffer Inverse { double inverse[]; };
double rightAt(uint u) { return u == gl_WorkGroupID.z ? 1.0 : 0.0; }
void   write(uint u, double value) { inverse[gl_WorkGroupID.z * push.unknowns + u] = value; }
#else
layout(std430, binding = 1) readonly buffer Places { int places[]; };
layout(std430, binding = 2) readonly buffer Right { float b[]; };
layout(std430, binding = 3) writeonly buffer Fields { float x[]; };
uint   at(uint u) { return gl_WorkGroupID.z * push.numbers + uint(places[u]); }
double rightAt(uint u) { return double(b[at(u)]); }
void   write(uint u, double value) { x[at(u)] = float(value); }
#endif

shared double y[kMostShellUnknowns];
shared double sums[kShellLanes];
shared double columns[kShellTogether]; // of L, many at a time: one after the other would wait for memory each

// Reads so many columns from the first one on.
void bring(uint first, uint count, uint stride)
{
    barrier();
    for (uint n = gl_LocalInvocationID.x; n < count * stride; n += gl_WorkGroupSize.x)
        columns[n] = factors[first * stride + n];
    barrier();
}

void main()
{
    uint lane = gl_LocalInvocationID.x, lanes = gl_WorkGroupSize.x;
    uint band = push.halfBand, stride = band + 1u;
    for (uint u = lane; u < kMostShellUnknowns; u += lanes) y[u] = u < push.unknowns ? rightAt(u) : 0.0;
    // Forwards every invocation solves for a pair at once: it waits for the others once instead of twice.
    uint together = kShellTogether / stride / 2u * 2u;
    for (uint c = 0u; c < push.unknowns; c += 2u) {
        uint column = c % together * stride;
        if (column == 0u) bring(c, min(together, push.unknowns - c), stride);
        bool   paired = c + 1u < push.unknowns;
        double first = y[c], second = y[c + 1u] - columns[column + 1u] * first;
        for (uint m = 2u + lane; m <= band + 1u; m += lanes) {
            double rest = y[c + m];
            if (m <= band) rest -= columns[column + m] * first;
            if (paired) rest -= columns[column + stride + m - 1u] * second;
            y[c + m] = rest;
        }
        barrier();
        if (paired && lane == 0u) y[c + 1u] = second; // nobody reads it on the way
    }
    uint whole = band / kShellLanes * kShellLanes, begin = 0u;
    for (uint n = 0u; n < push.unknowns; ++n) {
        uint c = push.unknowns - 1u - n;
        if (n % together == 0u) {
            begin = c + 1u > together ? c + 1u - together : 0u;
            bring(begin, c + 1u - begin, stride);
        }
        uint column = (c - begin) * stride;
        for (uint k = lane; k < kShellLanes; k += lanes) {
            double sum = 0.0;
            for (uint m = 1u + k; m <= whole; m += kShellLanes) sum += columns[column + m] * y[c + m];
            sums[k] = sum;
        }
        barrier();
        if (lane == 0u) {
            double sum = 0.0;
            for (uint m = whole + 1u; m <= band; ++m) sum += columns[column + m] * y[c + m];
            for (uint k = 0u; k < kShellLanes; ++k) sum += sums[k];
            y[c] = columns[column] * y[c] - sum;
        }
        barrier();
    }
    for (uint u = lane; u < push.unknowns; u += lanes) write(u, y[u]);
}
