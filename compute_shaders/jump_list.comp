// jump_list.comp - the marked tiles as a list, in their own order.
// Domain     one workgroup; each invocation lists a stretch of the tiles
// Reads      marks of the tiles
// Writes     number of marked tiles, at most kMostListed, then their indices
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/tile_layout.h"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Marks { uint marks[]; };
layout(std430, binding = 1) writeonly buffer List { uint list[]; };

uint markOf(int tile) { return marks[tile]; }
void put(uint place, uint word) { list[place] = word; }

#include "compute_shaders/jump_list.glsl"

void main()
{
    uint count = listTiles(push.level);
    if (gl_LocalInvocationIndex == gl_WorkGroupSize.x - 1u) list[0] = count;
}
