// plate_sweep.comp - sweeps of a level, or of the tiles where its rigidity jumps, in one dispatch.
// Domain     one workgroup along x per kOwned x kOwned nodes, see plate_region.glsl; z: loads
// Reads      rigidity and foundation [1], inverse divisor [1], force, deflection of this level; marks of tiles
// Writes     deflection, 0 on held nodes
//
// Of the tiles the sweeps equal those of plate_relax_tile.comp and plate_copy_tile.comp, to the bit: four dispatches
// each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require // unrolled sweeps take a driver seconds to compile

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/region_layout.h"
#include "compute_shaders/shared/tile_layout.h"

layout(push_constant) uniform Constants { SweepPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer Force { float force[]; };
layout(std430, binding = 3) readonly buffer Marks { uint marks[]; };
layout(std430, binding = 4) readonly buffer Before { float before[]; };
layout(std430, binding = 5) writeonly buffer After { float after[]; };

PlateLevel region() { return push.level; }

const int kBeyond = 0;
float forceAt(int i, int j);
bool  isSwept(int i, int j)
{
    return push.tilesOnly == 0u || marks[i / kTile * tilesZ(push.level) + j / kTile] == 1u;
}

#include "compute_shaders/plate_region.glsl"

float forceAt(int i, int j) { return force[base + nodeAt(i, j)]; }

void main()
{
    startRegion();
    int lane = int(gl_LocalInvocationID.x);
    for (int n = lane; n < kRegion * kRegion; n += kLanes) {
        int i = cornerI + n / kRegion, j = cornerJ + n % kRegion;
        if (isNode(i, j)) tile[n] = before[base + nodeAt(i, j)];
    }
    barrier();
    [[dont_unroll]] for (int turn = 1; turn <= 2 * kSweeps; ++turn)
        relaxRegion((push.first + uint(turn - 1)) & 1u, 2 * turn);
    for (int n = lane; n < kOwned * kOwned; n += kLanes) {
        int i = cornerI + kRim + n / kOwned, j = cornerJ + kRim + n % kOwned;
        if (isNode(i, j)) after[base + nodeAt(i, j)] = deflection(i, j);
    }
}
