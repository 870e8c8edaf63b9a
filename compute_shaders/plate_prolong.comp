// plate_prolong.comp - deflection of a level interpolated on the next finer one.
// Domain     one invocation per fine node
// Reads      transfer tables along x and z, coarse deflection (float with PALPATE_FROM_FLOAT); with PALPATE_ADDS the
//            fine deflection to correct
// Writes     fine deflection, 0 on held nodes
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { TransferPush push; };
layout(std430, binding = 0) readonly buffer TableX { float tablesX[]; };
layout(std430, binding = 1) readonly buffer TableZ { float tablesZ[]; };
#ifdef PALPATE_FROM_FLOAT
layout(std430, binding = 2) readonly buffer Coarse { float coarse[]; };
#else
layout(std430, binding = 2) readonly buffer Coarse { real coarse[]; };
#endif
layout(std430, binding = 3) writeonly buffer After { real after[]; };
#ifdef PALPATE_ADDS
layout(std430, binding = 4) readonly buffer Before { real before[]; };
#endif

int base;
float tableX(int n) { return tablesX[n]; }
float tableZ(int n) { return tablesZ[n]; }
real coarseValue(int i, int j) { return real(coarse[base + i * nodesZ(push.coarse) + j]); }

#define PALPATE_PROLONGS
#include "compute_shaders/shared/transfer_layout.h"
#include "compute_shaders/shared/plate_transfer.h"

void main()
{
    PlateLevel g = push.fine;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    base = firstOfLoad(push.coarse);
    int n = firstOfLoad(g) + i * nodesZ(g) + j;
#ifdef PALPATE_ADDS
    after[n] = before[n] + prolongedAt(i, j);
#else
    after[n] = prolongedAt(i, j);
#endif
}
