// shell_relax.comp - one half sweep of relaxation of both fields of a shell: the nodes of one colour change, from what
//                    all nodes were before.
// Domain     x: places of a row; y: rows; z: loads
// Reads      coefficients, right side, the fields before (not with PALPATE_FIRST, where they are 0)
// Writes     the fields, of all nodes
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellPassPush push; };
layout(std430, binding = 0) readonly buffer Entries { float entries[]; };
layout(std430, binding = 1) readonly buffer Right { float b[]; };
#ifdef PALPATE_FIRST
layout(std430, binding = 2) writeonly buffer After { float after[]; };
#else
layout(std430, binding = 2) readonly buffer Before { float x[]; };
layout(std430, binding = 3) writeonly buffer After { float after[]; };
#include "compute_shaders/shell_rows.glsl"
#endif
#include "compute_shaders/shell_relaxed.glsl"

void main()
{
    ShellLayout l = push.fine;
    if (!isNode(l)) return;
    int  i = nodeX(), j = nodeZ(l), atW = placeIn(l, i, j, 0), atF = placeIn(l, i, j, 1);
    bool moves = ((i + j + push.colour) & 1) == 0;
#ifdef PALPATE_FIRST
    precise ShellNode left = ShellNode(b[atW], b[atF]), before = ShellNode(0.0f, 0.0f);
#else
    precise ShellNode before = ShellNode(x[atW], x[atF]), left = ShellNode(0.0f, 0.0f);
    if (moves) {
        ShellRow row = shellRow(l, i, j);
        left.w       = b[atW] - row.w;
        left.f       = b[atF] - row.f;
    }
#endif
    ShellNode now = before;
    if (moves) now = relaxed(l, i, j, before, left);
    after[atW] = now.w;
    after[atF] = now.f;
}
