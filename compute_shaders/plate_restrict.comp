// plate_restrict.comp - forces of a level gathered on the next coarser one, the transpose of plate_prolong.comp.
// Domain     one invocation per coarse node
// Reads      transfer tables along x and z, forces of the fine level
// Writes     forces of the coarse level, 0 on held nodes
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { TransferPush push; };
layout(std430, binding = 0) readonly buffer TableX { float tablesX[]; };
layout(std430, binding = 1) readonly buffer TableZ { float tablesZ[]; };
layout(std430, binding = 2) readonly buffer Fine { float fine[]; };
layout(std430, binding = 3) writeonly buffer Coarse { float coarse[]; };

int base;
float tableX(int n) { return tablesX[n]; }
float tableZ(int n) { return tablesZ[n]; }
float fineValue(int i, int j) { return fine[base + i * nodesZ(push.fine) + j]; }

#define PALPATE_RESTRICTS
#include "compute_shaders/shared/transfer_layout.h"
#include "compute_shaders/shared/plate_transfer.h"

void main()
{
    PlateLevel g = push.coarse;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    base = firstOfLoad(push.fine); // held nodes get nothing: their weights are 0
    coarse[firstOfLoad(g) + i * nodesZ(g) + j] = restrictedAt(i, j, nodesX(push.fine), nodesZ(push.fine));
}
