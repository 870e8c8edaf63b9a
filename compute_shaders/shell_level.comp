// shell_level.comp - a small level of a shell's cycle in one dispatch. With PALPATE_DOWN: two sweeps from nothing, and
//                    the restriction of what is left; else what the coarser level found, and two sweeps more.
// Domain     one workgroup per load, whose invocations take turns over the nodes
// Reads      coefficients, right side, tables of both fields (shared/transfer_layout.h), else the coarser level's fields
// Writes     fields; what is left and the coarser level's right side, or a half sweep's nodes until they are taken
//
// The passes are those of shell_relax, shell_residual and shell_transfer, to the bit. On hardware each of them is
// launched for as long as a small level's nodes take.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellPassPush push; };
layout(std430, binding = 0) readonly buffer Entries { float entries[]; };
layout(std430, binding = 1) readonly buffer Right { float b[]; };
layout(std430, binding = 2) readonly buffer TableXW { float tableXW[]; };
layout(std430, binding = 3) readonly buffer TableXF { float tableXF[]; };
layout(std430, binding = 4) readonly buffer TableZW { float tableZW[]; };
layout(std430, binding = 5) readonly buffer TableZF { float tableZF[]; };
layout(std430, binding = 6) coherent buffer Fields { float x[]; };
#ifdef PALPATE_DOWN
layout(std430, binding = 7) coherent buffer Left { float from[]; }; // before, the nodes of a half sweep
layout(std430, binding = 8) writeonly buffer Coarse { float to[]; };
#define turned from
#else
layout(std430, binding = 7) coherent buffer Turned { float turned[]; };
layout(std430, binding = 8) readonly buffer Coarse { float from[]; };
#endif
#include "compute_shaders/shell_rows.glsl"
#include "compute_shaders/shell_relaxed.glsl"
#include "compute_shaders/shell_transfer.glsl"

const int kHalfSweeps = 4;

void together()
{
    memoryBarrierBuffer();
    barrier();
}

int placesOf(ShellLayout l) { return (l.cellsX + 1) * 2 * l.span; }

// The n-th place's node: in the order of memory, for all but those beyond a row's last node.
bool nodeAt(ShellLayout l, int n, out int i, out int j)
{
    int place = n % (2 * l.span), odd = place >= l.span ? 1 : 0;
    i = n / (2 * l.span);
    j = 2 * (place - odd * l.span) + odd;
    return j <= l.cellsZ;
}

// One half sweep; nodes of one colour see each other as they were before.
void relax(ShellLayout l, int colour, bool first)
{
    int i, j;
    for (int n = int(gl_LocalInvocationID.x); n < placesOf(l); n += int(gl_WorkGroupSize.x)) {
        if (!nodeAt(l, n, i, j)) continue;
        int               atW = placeIn(l, i, j, 0), atF = placeIn(l, i, j, 1);
        bool              moves  = ((i + j + colour) & 1) == 0;
        precise ShellNode before = ShellNode(0.0f, 0.0f), left = ShellNode(b[atW], b[atF]);
        if (moves && !first) {
            ShellRow row = shellRow(l, i, j);
            before       = ShellNode(x[atW], x[atF]);
            left.w       = b[atW] - row.w;
            left.f       = b[atF] - row.f;
        }
        ShellNode now = before;
        if (moves) now = relaxed(l, i, j, before, left);
        if (moves || first) {
            turned[atW] = now.w;
            turned[atF] = now.f;
        }
    }
    together();
    for (int n = int(gl_LocalInvocationID.x); n < placesOf(l); n += int(gl_WorkGroupSize.x)) {
        if (!nodeAt(l, n, i, j) || (!first && ((i + j + colour) & 1) != 0)) continue;
        for (int field = 0; field < 2; ++field) x[placeIn(l, i, j, field)] = turned[placeIn(l, i, j, field)];
    }
    together();
}

#ifdef PALPATE_DOWN
void main()
{
    ShellLayout l = push.fine, coarse = push.coarse;
    int         i, j;
    for (int n = 0; n < kHalfSweeps; ++n) relax(l, n & 1, n == 0);
    for (int n = int(gl_LocalInvocationID.x); n < placesOf(l); n += int(gl_WorkGroupSize.x)) {
        if (!nodeAt(l, n, i, j)) continue;
        int      atW = placeIn(l, i, j, 0), atF = placeIn(l, i, j, 1);
        ShellRow row = shellRow(l, i, j);
        from[atW]    = b[atW] - row.w;
        from[atF]    = b[atF] - row.f;
    }
    together();
    for (int n = int(gl_LocalInvocationID.x); n < placesOf(coarse); n += int(gl_WorkGroupSize.x))
        if (nodeAt(coarse, n, i, j))
            for (int field = 0; field < 2; ++field)
                to[placeIn(coarse, i, j, field)] = restrictedAt(l, i, j, field);
}
#else
void main()
{
    ShellLayout l = push.fine;
    int         i, j;
    for (int n = int(gl_LocalInvocationID.x); n < placesOf(l); n += int(gl_WorkGroupSize.x))
        if (nodeAt(l, n, i, j))
            for (int field = 0; field < 2; ++field) {
                int at = placeIn(l, i, j, field);
                x[at]  = prolongedAt(push.coarse, i, j, field, x[at]);
            }
    together();
    for (int n = 1; n <= kHalfSweeps; ++n) relax(l, n & 1, false);
}
#endif
