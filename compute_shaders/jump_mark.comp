// jump_mark.comp - tiles in which the rigidity jumps, see jump_tiles.h.
// Domain     one invocation per tile, x along z
// Reads      rigidity of the level [1]
// Writes     1 for a tile with a jump, else 0
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/tile_layout.h"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) writeonly buffer Marks { uint marks[]; };

float rigidity(int i, int j) { return D[i * nodesZ(push.level) + j]; }

#include "compute_shaders/shared/jump_tiles.h"

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i >= tilesX(g) || j >= tilesZ(g)) return;
    marks[i * tilesZ(g) + j] = jumpsInTile(g, i, j) ? 1u : 0u;
}
