// coarse_solve.comp - deflection of the coarsest level by forward and backward substitution, L L' w = f.
// Domain     one workgroup per load
// Reads      columns of L with inverse diagonal (real), forces of the coarsest level
// Writes     deflection of the coarsest level
//
// With PALPATE_INVERTS load n is a unit force at node n, and column n of the inverse is written, as pairs of floats: a
// plate that is softly held sinks by a thousand times more than it bends, and floats would round the bending away.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/plate_grid.h"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Factor { real factor[]; };
#ifdef PALPATE_INVERTS
layout(std430, binding = 1) writeonly buffer Inverse { vec2 inverse[]; };
real forceAt(int base, int node) { return node == int(gl_WorkGroupID.z) ? real(1.0f) : real(0.0f); }
void write(int at, real value) { inverse[at] = vec2(float(value), float(value - real(float(value)))); }
#else
layout(std430, binding = 1) readonly buffer Force { float force[]; };
layout(std430, binding = 2) writeonly buffer Deflection { float w[]; };
real forceAt(int base, int node) { return real(force[base + node]); }
void write(int at, real value) { w[at] = float(value); }
#endif

shared real right[kMostCoarseNodes], middle[kMostCoarseNodes];
shared bool moves[kMostCoarseNodes];

int nodeOf(PlateLevel g, int unknown) { return columnOf(g, unknown) * nodesZ(g) + rowOf(g, unknown); }

void main()
{
    PlateLevel g = push.level;
    int reach = halfBand(g), slots = reach + 1;
    int unknowns = nodesX(g) * nodesZ(g), base = int(gl_WorkGroupID.z) * unknowns;
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    for (int n = lane; n < unknowns; n += lanes) {
        bool held = isHeld(g, columnOf(g, n), rowOf(g, n));
        right[n]  = held ? real(0.0f) : forceAt(base, nodeOf(g, n));
        middle[n] = real(0.0f);
        moves[n]  = !held;
    }
    barrier();
    for (int n = 0; n < unknowns; ++n) {
        if (!moves[n]) continue; // a held node is 0 and changes nothing; the branch is the same for all invocations
        barrier();
        real solved = right[n] * factor[n * slots];
        if (lane == 0) middle[n] = solved;
        for (int d = 1 + lane; d <= reach && n + d < unknowns; d += lanes) right[n + d] -= factor[n * slots + d] * solved;
    }
    for (int n = unknowns - 1; n >= 0; --n) {
        if (!moves[n]) continue;
        barrier();
        real solved = middle[n] * factor[n * slots];
        if (lane == 0) right[n] = solved;
        for (int d = 1 + lane; d <= reach && d <= n; d += lanes)
            middle[n - d] -= factor[(n - d) * slots + d] * solved;
    }
    barrier();
    for (int n = lane; n < unknowns; n += lanes) write(base + nodeOf(g, n), right[n]);
}
