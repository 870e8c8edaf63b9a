// plate_up.comp - the way up of a cycle on one level: the correction from below, and sweeps.
// Domain     one workgroup along x per kOwned x kOwned nodes, see plate_region.glsl; z: loads
// Reads      rigidity [1], inverse divisor [1], transfer tables; coarse deflection; force and deflection of this level
// Writes     deflection z, 0 on held nodes
// Reads      with PALPATE_AIMS, where the cycle is that of conjugate gradients: residual r, answer x (real), load f
// Writes     with it sums of the workgroups (real): (r, z), (f, x); and the state of the load, see cg_state.h
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require // unrolled sweeps take a driver seconds to compile

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/region_layout.h"
#undef real
#define real float // in the cycle

#ifdef PALPATE_AIMS
layout(push_constant) uniform Constants { UpPush push; };
#else
layout(push_constant) uniform Constants { TransferPush push; };
#endif
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer TableX { float tablesX[]; };
layout(std430, binding = 3) readonly buffer TableZ { float tablesZ[]; };
layout(std430, binding = 4) readonly buffer Force { float force[]; };
layout(std430, binding = 5) readonly buffer Coarse { float coarse[]; };
layout(std430, binding = 6) readonly buffer Before { float before[]; };
layout(std430, binding = 7) writeonly buffer After { float after[]; };

PlateLevel region() { return push.fine; }

const int kBeyond = 0;
float forceAt(int i, int j);
bool  isSwept(int i, int j) { return true; }

#include "compute_shaders/plate_region.glsl"

float forceAt(int i, int j) { return force[base + nodeAt(i, j)]; }

int coarseBase;
float tableX(int n) { return tablesX[n]; }
float tableZ(int n) { return tablesZ[n]; }
float coarseValue(int i, int j) { return coarse[coarseBase + i * nodesZ(push.coarse) + j]; }

#define PALPATE_PROLONGS
#include "compute_shaders/shared/transfer_layout.h"
#include "compute_shaders/shared/plate_transfer.h"

#include "compute_shaders/plate_real.glsl"
#ifdef PALPATE_AIMS
layout(std430, binding = 8) readonly buffer Residual { real r[]; };
layout(std430, binding = 9) readonly buffer Answer { real x[]; };
layout(std430, binding = 10) readonly buffer Load { float f[]; };
layout(std430, binding = 11) coherent buffer Partials { real partials[]; };
layout(std430, binding = 12) coherent buffer Tickets { uint tickets[]; };
layout(std430, binding = 13) buffer State { real state[]; };

#include "compute_shaders/cg_aimed.glsl"
#endif

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
#ifdef PALPATE_AIMS
    real rz = real(0.0f), fx = real(0.0f);
#endif
    for (int n = lane; n < kOwned * kOwned; n += kLanes) {
        int i = cornerI + kRim + n / kOwned, j = cornerJ + kRim + n % kOwned;
        if (!isNode(i, j)) continue;
        int at = base + nodeAt(i, j);
        after[at] = deflection(i, j);
#ifdef PALPATE_AIMS
        rz += r[at] * real(deflection(i, j));
        fx += real(f[at]) * x[at];
#endif
    }
#ifdef PALPATE_AIMS
    aim(gl_GlobalInvocationID.z, rz, fx, push.begins);
#endif
}
