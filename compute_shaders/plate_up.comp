// plate_up.comp - the way up of a cycle on one level: the correction from below, and sweeps.
// Domain     one workgroup along x per kOwned x kOwned nodes, see plate_region.glsl; z: loads
// Reads      rigidity [1], inverse divisor [1], force and deflection of this level; transfer tables; coarse deflection
// Writes     deflection, 0 on held nodes
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require // unrolled sweeps take a driver seconds to compile

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { TransferPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer Force { float force[]; };
layout(std430, binding = 3) readonly buffer TableX { float tablesX[]; };
layout(std430, binding = 4) readonly buffer TableZ { float tablesZ[]; };
layout(std430, binding = 5) readonly buffer Coarse { float coarse[]; };
layout(std430, binding = 6) readonly buffer Before { float before[]; };
layout(std430, binding = 7) writeonly buffer After { float after[]; };

PlateLevel region() { return push.fine; }

#include "compute_shaders/plate_region.glsl"

int coarseBase;
float tableX(int n) { return tablesX[n]; }
float tableZ(int n) { return tablesZ[n]; }
float coarseValue(int i, int j) { return coarse[coarseBase + i * nodesZ(push.coarse) + j]; }

#define PALPATE_PROLONGS
#include "compute_shaders/shared/transfer_layout.h"
#include "compute_shaders/shared/plate_transfer.h"

void main()
{
    startRegion();
    coarseBase = firstOfLoad(push.coarse);
    int lane = int(gl_LocalInvocationID.x);
    for (int n = lane; n < kRegion * kRegion; n += kLanes) {
        int i = cornerI + n / kRegion, j = cornerJ + n % kRegion;
        if (isNode(i, j)) tile[n] = before[base + nodeAt(i, j)] + prolongedAt(i, j);
    }
    barrier();
    [[dont_unroll]] for (int turn = 1; turn <= 2 * kSweeps; ++turn) relaxRegion(uint(turn & 1), 2 * turn);
    for (int n = lane; n < kOwned * kOwned; n += kLanes) {
        int i = cornerI + kRim + n / kOwned, j = cornerJ + kRim + n % kOwned;
        if (isNode(i, j)) after[base + nodeAt(i, j)] = deflection(i, j);
    }
}
