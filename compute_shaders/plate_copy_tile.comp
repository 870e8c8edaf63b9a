// plate_copy_tile.comp - copies the deflections that plate_relax_tile.comp wrote aside.
// Domain     as plate_relax_tile.comp
// Reads      list of tiles, new deflections
// Writes     deflection of nodes of push.colour of these tiles
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/tile_layout.h"

layout(push_constant) uniform Constants { RelaxPush push; };
layout(std430, binding = 0) readonly buffer List { uint list[]; };
layout(std430, binding = 1) readonly buffer Aside { float aside[]; };
layout(std430, binding = 2) writeonly buffer Deflection { float w[]; };

void main()
{
    PlateLevel g = push.level;
    int tile = int(list[1u + gl_WorkGroupID.x]);
    int i = tile / tilesZ(g) * kTile + int(gl_LocalInvocationID.y);
    int j = tile % tilesZ(g) * kTile + int(gl_LocalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ || ((uint(i + j) + push.colour) & 1u) != 0u) return;
    int n = firstOfLoad(g) + i * nodesZ(g) + j;
    w[n] = aside[n];
}
