// shell_transfer.comp - fields of a shell between two levels, by the plate's tables, each field by its own.
// Domain     x: places of a row; y: rows; z: loads; of the level that is written
// Reads      tables of w and phi along x, and along z (shared/transfer_layout.h); fields of the other level
// Writes     with PALPATE_RESTRICTS the coarse fields; else adds to the fine ones, or puts them if push.fromZero
//
// The sums are those of the host: a restriction sums along x first, an interpolation along z, and no weight of 0
// counts.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"
#include "compute_shaders/shared/transfer_layout.h"

layout(push_constant) uniform Constants { ShellPassPush push; };
layout(std430, binding = 0) readonly buffer TableXW { float tableXW[]; };
layout(std430, binding = 1) readonly buffer TableXF { float tableXF[]; };
layout(std430, binding = 2) readonly buffer TableZW { float tableZW[]; };
layout(std430, binding = 3) readonly buffer TableZF { float tableZF[]; };
layout(std430, binding = 4) readonly buffer From { float from[]; };
layout(std430, binding = 5) buffer To { float to[]; };

float alongX(int field, int n) { return field == 0 ? tableXW[n] : tableXF[n]; }
float alongZ(int field, int n) { return field == 0 ? tableZW[n] : tableZF[n]; }

#ifdef PALPATE_RESTRICTS
void main()
{
    ShellLayout fine = push.fine, coarse = push.coarse;
    if (!isNode(coarse)) return;
    int i = nodeX(), j = nodeZ(coarse);
    int atX = kFineStride * (fine.cellsX + 1) + kCoarseStride * i, atZ = kFineStride * (fine.cellsZ + 1) + kCoarseStride * j;
    for (int field = 0; field < 2; ++field) {
        int   firstX = int(alongX(field, atX)), firstZ = int(alongZ(field, atZ));
        float sum    = 0.0f;
        for (int n = 0; n < kCoarseWeights; ++n) {
            float weight = alongZ(field, atZ + 1 + n);
            if (weight == 0.0f) continue;
            float between = 0.0f;
            for (int m = 0; m < kCoarseWeights; ++m) {
                float inner = alongX(field, atX + 1 + m);
                if (inner != 0.0f) between += inner * from[placeIn(fine, firstX + m, firstZ + n, field)];
            }
            sum += weight * between;
        }
        to[placeIn(coarse, i, j, field)] = sum;
    }
}
#else
void main()
{
    ShellLayout fine = push.fine, coarse = push.coarse;
    if (!isNode(fine)) return;
    int i = nodeX(), j = nodeZ(fine), atX = kFineStride * i, atZ = kFineStride * j;
    for (int field = 0; field < 2; ++field) {
        int   firstX = int(alongX(field, atX)), firstZ = int(alongZ(field, atZ)), at = placeIn(fine, i, j, field);
        float sum    = push.fromZero != 0u ? 0.0f : to[at];
        for (int m = 0; m < kFineWeights; ++m) {
            float weight = alongX(field, atX + 1 + m);
            if (weight == 0.0f) continue;
            float between = 0.0f;
            for (int n = 0; n < kFineWeights; ++n) {
                float inner = alongZ(field, atZ + 1 + n);
                if (inner != 0.0f) between += inner * from[placeIn(coarse, firstX + m, firstZ + n, field)];
            }
            sum += weight * between;
        }
        to[at] = sum;
    }
}
#endif
