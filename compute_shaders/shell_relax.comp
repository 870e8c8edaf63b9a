// shell_relax.comp - one half sweep of relaxation of both fields of a shell: the nodes of one colour change, from what
// all
//                    nodes were before.
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

float inverseAt(int plane, int i, int j)
{
    ShellLayout l = push.fine;
    return entries[((i + kShellRim) * kShellPlanes + plane) * 2 * l.span + placeOf(l, j)];
}

void main()
{
    ShellLayout l = push.fine;
    if (!isNode(l)) return;
    int  i = nodeX(), j = nodeZ(l), atW = placeIn(l, i, j, 0), atF = placeIn(l, i, j, 1);
    bool moves = ((i + j + push.colour) & 1) == 0;
#ifdef PALPATE_FIRST
    precise float w = b[atW], f = b[atF], wBefore = 0.0f, fBefore = 0.0f;
#else
    precise float wBefore = x[atW], fBefore = x[atF], w = 0.0f, f = 0.0f;
    if (moves) {
        ShellRow row = shellRow(l, i, j);
        w            = b[atW] - row.w;
        f            = b[atF] - row.f;
    }
#endif
    float ww = inverseAt(kInverseW, i, j), wf = inverseAt(kInverseWF, i, j), ff = inverseAt(kInverseF, i, j);
    precise float wAfter = wBefore + (ww * w + wf * f), fAfter = fBefore + (wf * w + ff * f);
    after[atW] = moves ? wAfter : wBefore;
    after[atF] = moves ? fAfter : fBefore;
}
