// plate_relax_tile.comp - half a sweep of relaxation in the tiles where the rigidity jumps; plate_copy_tile.comp
// follows. Domain     a workgroup of kTile x kTile per listed tile; invocations of the other colour return
// Reads      rigidity and foundation [1], inverse divisor [1], force, deflection of this level; list of tiles
// Writes     new deflections of nodes of push.colour of these tiles, aside: others still need the old ones
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/tile_layout.h"

layout(push_constant) uniform Constants { RelaxPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer Force { float force[]; };
layout(std430, binding = 3) readonly buffer Deflection { float w[]; };
layout(std430, binding = 4) readonly buffer List { uint list[]; };
layout(std430, binding = 5) writeonly buffer Aside { float aside[]; };

int base;
float rigidity(int i, int j) { return D[i * nodesZ(push.level) + j]; }
float foundationShape(int i, int j) { return D[push.level.shapeAt + i * nodesZ(push.level) + j]; }
float deflection(int i, int j) { return w[base + i * nodesZ(push.level) + j]; }
float otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"

void main()
{
    PlateLevel g = push.level;
    int tile = int(list[1u + gl_WorkGroupID.x]);
    int i = tile / tilesZ(g) * kTile + int(gl_LocalInvocationID.y);
    int j = tile % tilesZ(g) * kTile + int(gl_LocalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ || ((uint(i + j) + push.colour) & 1u) != 0u) return;
    base = firstOfLoad(g);
    int n = i * nodesZ(g) + j;
    aside[base + n] = relaxed(deflection(i, j), force[base + n], operatorAt(g, i, j), inverseDivisor[n]);
}
