// rigidity_coarsen.comp - rigidity and foundation of the next coarser level.
// Domain     one invocation per coarse node
// Reads      rigidity and foundation of the fine level [1]
// Writes     those of the coarse level [1]
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { TransferPush push; };
layout(std430, binding = 0) readonly buffer Fine { float fine[]; };
layout(std430, binding = 1) writeonly buffer Coarse { float coarse[]; };

float fineRigidity(int i, int j) { return fine[i * nodesZ(push.fine) + j]; }
float fineShape(int i, int j) { return fine[push.fine.shapeAt + i * nodesZ(push.fine) + j]; }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/rigidity_coarsen.h"

void main()
{
    PlateLevel g = push.coarse;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    coarse[i * nodesZ(g) + j] = coarseRigidityAt(push.fine, g, i, j);
    if (g.shapeAt != 0) coarse[g.shapeAt + i * nodesZ(g) + j] = coarseShapeAt(push.fine, g, i, j);
}
