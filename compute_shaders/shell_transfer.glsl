// shell_transfer.glsl - a number of a shell's field from those of the other level, by the plate's tables.
//
// The sums are those of the host: a restriction sums along x first, an interpolation along z, and no weight of 0
// counts.
// The includer declares  tableXW, tableXF, tableZW, tableZF,  tables of w and phi along x, and along z
// (shared/transfer_layout.h), and  from,  the fields of the other level.

#include "compute_shaders/shared/transfer_layout.h"

float alongX(int field, int n) { return field == 0 ? tableXW[n] : tableXF[n]; }
float alongZ(int field, int n) { return field == 0 ? tableZW[n] : tableZF[n]; }

// At a coarse node.
float restrictedAt(ShellLayout fine, int i, int j, int field)
{
    int   atX    = kFineStride * (fine.cellsX + 1) + kCoarseStride * i;
    int   atZ    = kFineStride * (fine.cellsZ + 1) + kCoarseStride * j;
    int   firstX = int(alongX(field, atX)), firstZ = int(alongZ(field, atZ));
    float sum = 0.0f;
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
    return sum;
}

// At a fine node, added to what is there.
float prolongedAt(ShellLayout coarse, int i, int j, int field, float sum)
{
    int atX = kFineStride * i, atZ = kFineStride * j;
    int firstX = int(alongX(field, atX)), firstZ = int(alongZ(field, atZ));
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
    return sum;
}
