// shell_transfer.comp - fields of a shell between two levels.
// Domain     x: places of a row; y: rows; z: loads; of the level that is written
// Reads      tables of w and phi along x, and along z (shared/transfer_layout.h); fields of the other level
// Writes     with PALPATE_RESTRICTS the coarse fields; else adds to the fine ones, or puts them if push.fromZero
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellPassPush push; };
layout(std430, binding = 0) readonly buffer TableXW { float tableXW[]; };
layout(std430, binding = 1) readonly buffer TableXF { float tableXF[]; };
layout(std430, binding = 2) readonly buffer TableZW { float tableZW[]; };
layout(std430, binding = 3) readonly buffer TableZF { float tableZF[]; };
layout(std430, binding = 4) readonly buffer From { float from[]; };
layout(std430, binding = 5) buffer To { float to[]; };
#include "compute_shaders/shell_transfer.glsl"

void main()
{
#ifdef PALPATE_RESTRICTS
    ShellLayout l = push.coarse;
#else
    ShellLayout l = push.fine;
#endif
    if (!isNode(l)) return;
    int i = nodeX(), j = nodeZ(l);
    for (int field = 0; field < 2; ++field) {
        int at = placeIn(l, i, j, field);
#ifdef PALPATE_RESTRICTS
        to[at] = restrictedAt(push.fine, i, j, field);
#else
        to[at] = prolongedAt(push.coarse, i, j, field, push.fromZero != 0u ? 0.0f : to[at]);
#endif
    }
}
