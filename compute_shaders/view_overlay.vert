// view_overlay.vert - the squares of the picture in which an overlay has something to show.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compute_shaders/view_prelude.glsl"

layout(std430, binding = kBindTiles) readonly buffer Tiles { uint tiles[]; };

void main()
{
    const vec2 kCorners[6] = vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));
    uint tile   = tiles[gl_VertexIndex / 6];
    vec2 at     = (vec2(tile & 0xFFFFu, tile >> 16) + kCorners[gl_VertexIndex % 6]) * float(kTile);
    gl_Position = vec4(2.0 * at / vec2(frame.width, frame.height) - 1.0, 0, 1);
}
