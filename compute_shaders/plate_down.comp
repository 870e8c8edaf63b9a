// plate_down.comp - the way down of a cycle on one level: sweeps from zero deflection, the residual, and its
// restriction. Domain     one workgroup along x per kOwned x kOwned nodes, see plate_region.glsl; z: loads
// Reads      rigidity and foundation [1], inverse divisor [1], transfer tables
// Reads      force of this level; with PALPATE_UPDATES instead what gives it: the state's alpha, direction p and its
//            forces q = A p, the residual r before the step (real)
// Writes     deflection of this level, force of the coarser one, 0 on held nodes
// Writes     with PALPATE_UPDATES the step of conjugate gradients as cg_update.comp takes it: answer x (real), residual
//            (real; to a memory of its own, because workgroups read what others own), force of this level
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require // unrolled sweeps take a driver seconds to compile

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/region_layout.h"
#undef real
#define real float // in the cycle

layout(push_constant) uniform Constants { TransferPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer TableX { float tablesX[]; };
layout(std430, binding = 3) readonly buffer TableZ { float tablesZ[]; };
layout(std430, binding = 4) writeonly buffer Deflection { float w[]; };
layout(std430, binding = 5) writeonly buffer Coarse { float coarse[]; };
PlateLevel region() { return push.fine; }

shared float forces[kRegion * kRegion];
const int kBeyond = kGathered;
float forceAt(int i, int j);
bool  isSwept(int i, int j) { return true; }

#include "compute_shaders/plate_region.glsl"

float forceAt(int i, int j) { return forces[placeOf(i, j)]; }

const int kLeftSide = kOwned + 2 * kGathered; // of the square of residuals that own coarse nodes gather from [nodes]
shared float left[kLeftSide * kLeftSide];
int leftPlace(int i, int j) // the nearest one: beyond the square all weights are 0
{
    const int rim = kRim - kGathered;
    return clamp(i - cornerI - rim, 0, kLeftSide - 1) * kLeftSide + clamp(j - cornerJ - rim, 0, kLeftSide - 1);
}

float tableX(int n) { return tablesX[n]; }
float tableZ(int n) { return tablesZ[n]; }
float fineValue(int i, int j) { return left[leftPlace(i, j)]; }

#define PALPATE_RESTRICTS
#include "compute_shaders/shared/transfer_layout.h"
#include "compute_shaders/shared/plate_transfer.h"

#include "compute_shaders/plate_real.glsl"
#ifdef PALPATE_UPDATES
#include "compute_shaders/shared/cg_state.h"
layout(std430, binding = 6) writeonly buffer Force { float force[]; };
layout(std430, binding = 7) readonly buffer State { real state[]; };
layout(std430, binding = 8) readonly buffer Direction { real p[]; };
layout(std430, binding = 9) readonly buffer Forces { real q[]; };
layout(std430, binding = 10) readonly buffer Before { real before[]; };
layout(std430, binding = 11) writeonly buffer After { real after[]; };
layout(std430, binding = 12) buffer Answer { real x[]; };
#else
layout(std430, binding = 6) readonly buffer Force { float force[]; };
#endif

bool isOwn(int place) { return place >= kRim && place < kRim + kOwned; } // of a row or column of the region

// The first coarse node at or beyond a fine one, along a side.
int coarseFrom(int fine, int cellsFine, int cellsCoarse) { return (fine * cellsCoarse + cellsFine - 1) / cellsFine; }

void main()
{
    startRegion();
    PlateLevel g = push.fine, below = push.coarse;
    int lane = int(gl_LocalInvocationID.x);
#ifdef PALPATE_UPDATES
    real alpha = state[int(gl_GlobalInvocationID.z) * kStateWords + kStateAlpha];
#endif
    for (int n = lane; n < kRegion * kRegion; n += kLanes) { // the half sweep of colour 0 needs no operator
        int i = cornerI + n / kRegion, j = cornerJ + n % kRegion;
        if (!isNode(i, j)) continue;
        int at = base + nodeAt(i, j);
#ifdef PALPATE_UPDATES
        real rest = before[at] - alpha * q[at];
        float load = float(rest);
        if (isOwn(n / kRegion) && isOwn(n % kRegion)) {
            x[at] += alpha * p[at];
            after[at] = rest;
            force[at] = load;
        }
#else
        float load = force[at];
#endif
        forces[n] = load;
        tile[n] = ((i + j) & 1) == 0 ? load * inverseDivisor[nodeAt(i, j)] : 0.0f;
    }
    barrier();
    [[dont_unroll]] for (int turn = 1; turn < 2 * kSweeps; ++turn) relaxRegion(uint(turn & 1), 2 * turn);
    for (int n = lane; n < kLeftSide * kLeftSide; n += kLanes) {
        int i = cornerI + kRim - kGathered + n / kLeftSide, j = cornerJ + kRim - kGathered + n % kLeftSide;
        left[n] = isNode(i, j) && !isHeld(g, i, j) ? forceAt(i, j) - operatorAt(g, i, j) : 0.0f;
        if (isNode(i, j) && isOwn(i - cornerI) && isOwn(j - cornerJ)) w[base + nodeAt(i, j)] = deflection(i, j);
    }
    barrier();
    int firstI = coarseFrom(cornerI + kRim, g.cellsX, below.cellsX);
    int firstJ = coarseFrom(cornerJ + kRim, g.cellsZ, below.cellsZ);
    int countI = min(coarseFrom(cornerI + kRim + kOwned, g.cellsX, below.cellsX), nodesX(below)) - firstI;
    int countJ = min(coarseFrom(cornerJ + kRim + kOwned, g.cellsZ, below.cellsZ), nodesZ(below)) - firstJ;
    int coarseBase = firstOfLoad(below);
    for (int n = lane; n < countI * countJ; n += kLanes) {
        int i = firstI + n / countJ, j = firstJ + n % countJ;
        coarse[coarseBase + i * nodesZ(below) + j] = restrictedAt(i, j, nodesX(g), nodesZ(g));
    }
}
