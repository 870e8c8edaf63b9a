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

const int kMostInvocations = 256;
shared uint counts[kMostInvocations];

void main()
{
    int tiles = tilesX(push.level) * tilesZ(push.level);
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    int stretch = (tiles + lanes - 1) / lanes, first = lane * stretch, end = min(tiles, first + stretch);
    uint count = 0u;
    for (int n = first; n < end; ++n) count += marks[n];
    counts[lane] = count;
    barrier();
    uint at = 1u;
    for (int n = 0; n < lane; ++n) at += counts[n];
    if (lane == lanes - 1) list[0] = min(at - 1u + count, kMostListed);
    for (int n = first; n < end; ++n)
        if (marks[n] == 1u) list[at++] = uint(n);
}
