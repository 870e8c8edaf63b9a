// coarse_solve.comp - deflection of the coarsest level by forward and backward substitution, L L' w = f.
// Domain     one workgroup per load
// Reads      columns of L with inverse diagonal (real), forces of the coarsest level
// Writes     deflection of the coarsest level
//
// With PALPATE_INVERTS load n is a unit force at node n, and column n of the inverse is written (real).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/plate_grid.h"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Factor { real factor[]; };
#ifdef PALPATE_INVERTS
layout(std430, binding = 1) writeonly buffer Inverse { real inverse[]; };
real forceAt(int base, int node) { return node == int(gl_WorkGroupID.z) ? real(1.0f) : real(0.0f); }
void write(int at, real value) { inverse[at] = value; }
#else
layout(std430, binding = 1) readonly buffer Force { float force[]; };
layout(std430, binding = 2) writeonly buffer Deflection { float w[]; };
real forceAt(int base, int node) { return real(force[base + node]); }
void write(int at, real value) { w[at] = float(value); }
#endif

#ifdef PALPATE_INVERTS
// Columns of L, many at a time: of many workgroups that wait for their own, column after column, memory would be
// the time.
const int kTogether = kColumnsTogether;
shared real columns[(kTogether + kMostHalfBand) * (kMostHalfBand + 1)];
int firstColumn;

void bringColumns(int first, int count, int slots)
{
    barrier();
    firstColumn = first;
    for (int n = int(gl_LocalInvocationID.x); n < count * slots; n += int(gl_WorkGroupSize.x))
        columns[n] = factor[first * slots + n];
    barrier();
}

real entryOf(int column, int d, int slots) { return columns[(column - firstColumn) * slots + d]; }
#else
const int kTogether = kMostCoarseNodes; // they are read where they are used

void bringColumns(int first, int count, int slots) {}

real entryOf(int column, int d, int slots) { return factor[column * slots + d]; }
#endif

shared real right[kMostCoarseNodes], middle[kMostCoarseNodes];

const int kBlock = 4; // unknowns that every invocation solves for at once: it waits for the others once instead of four times

int nodeOf(PlateLevel g, int unknown) { return columnOf(g, unknown) * nodesZ(g) + rowOf(g, unknown); }

void main()
{
    PlateLevel g = push.level;
    int reach = halfBand(g), slots = reach + 1;
    int unknowns = nodesX(g) * nodesZ(g), base = int(gl_WorkGroupID.z) * unknowns;
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    for (int n = lane; n < unknowns; n += lanes) // a held node is 0 and changes nothing
        right[n] = isHeld(g, columnOf(g, n), rowOf(g, n)) ? real(0.0f) : forceAt(base, nodeOf(g, n));
    real solved[kBlock];
    for (int n = 0; n < unknowns; n += kBlock) {
        if (n % kTogether == 0) bringColumns(n, min(kTogether, unknowns - n), slots);
        barrier();
        for (int k = 0; k < kBlock; ++k) {
            if (n + k >= unknowns) break;
            solved[k] = right[n + k];
            for (int m = 0; m < k; ++m) solved[k] -= entryOf(n + m, k - m, slots) * solved[m];
            solved[k] *= entryOf(n + k, 0, slots);
            if (lane == 0) middle[n + k] = solved[k];
        }
        for (int d = kBlock + lane; d < kBlock + reach && n + d < unknowns; d += lanes) {
            real rest = right[n + d];
            for (int k = 0; k < kBlock; ++k)
                if (d - k <= reach) rest -= entryOf(n + k, d - k, slots) * solved[k];
            right[n + d] = rest;
        }
    }
    for (int n = unknowns - 1; n >= 0; n -= kBlock) {
        if ((unknowns - 1 - n) % kTogether == 0) {
            int first = max(0, n - (kTogether - 1) - reach);
            bringColumns(first, n + 1 - first, slots);
        }
        barrier();
        for (int k = 0; k < kBlock; ++k) {
            if (k > n) break;
            solved[k] = middle[n - k];
            for (int m = 0; m < k; ++m) solved[k] -= entryOf(n - k, k - m, slots) * solved[m];
            solved[k] *= entryOf(n - k, 0, slots);
            if (lane == 0) right[n - k] = solved[k];
        }
        for (int d = kBlock + lane; d < kBlock + reach && d <= n; d += lanes) {
            real rest = middle[n - d];
            for (int k = 0; k < kBlock; ++k)
                if (d - k <= reach) rest -= entryOf(n - d, d - k, slots) * solved[k];
            middle[n - d] = rest;
        }
    }
    barrier();
    for (int n = lane; n < unknowns; n += lanes) write(base + nodeOf(g, n), right[n]);
}
