// shell_residual.comp - what is left of the right side of a shell, b - K x; with PALPATE_APPLIES the product K x.
// Domain     x: places of a row; y: rows; z: loads
// Reads      coefficients, fields, and the right side
// Writes     fields
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellPassPush push; };
layout(std430, binding = 0) readonly buffer Entries { real entries[]; };
layout(std430, binding = 1) readonly buffer Fields { real x[]; };
layout(std430, binding = 2) writeonly buffer Result { real result[]; };
#ifndef PALPATE_APPLIES
layout(std430, binding = 3) readonly buffer Right { real b[]; };
#endif
#include "compute_shaders/shell_rows.glsl"

void main()
{
    ShellLayout l = push.fine;
    if (!isNode(l)) return;
    int      i = nodeX(), j = nodeZ(l), atW = placeIn(l, i, j, 0), atF = placeIn(l, i, j, 1);
    ShellRow row = shellRow(l, i, j);
#ifdef PALPATE_APPLIES
    result[atW] = row.w;
    result[atF] = row.f;
#else
    result[atW] = b[atW] - row.w;
    result[atF] = b[atF] - row.f;
#endif
}
