// plate_divisor.comp - inverse divisors of the relaxation, once per rigidity.
// Domain     x, y: nodes, workgroups are one row high; z: the kEntries entries of a node's row, in one workgroup. (One
//            invocation with a loop over the entries is a shader that some drivers compile for minutes.)
// Reads      rigidity [1]
// Writes     1/divisor [1]; 0 on held nodes
//
// Entries of the operator's row are its answers to unit deflections, so that there is no second list of them.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) writeonly buffer Divisor { float inverseDivisor[]; };

int unitI, unitJ;
float rigidity(int i, int j) { return D[i * nodesZ(push.level) + j]; }
float foundationShape(int i, int j) { return D[push.level.shapeAt + i * nodesZ(push.level) + j]; }
float deflection(int i, int j) { return i == unitI && j == unitJ ? 1.0f : 0.0f; }
float otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
#include "compute_shaders/shared/plate_divisor.h"

const int kMostNodes = 28; // of a workgroup: 9 times as many invocations are fewer than 256
shared float entries[kEntries][kMostNodes];

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    int m = int(gl_LocalInvocationID.z), node = int(gl_LocalInvocationID.x);
    bool inside = i <= g.cellsX && j <= g.cellsZ;
    entries[m][node] = inside ? entryOf(g, i, j, m) : 0.0f;
    barrier();
    if (!inside || m > 0) return;
    float others = 0.0f;
    for (int n = 0; n < kEntries - 1; ++n) others += entries[n][node];
    float divisor = relaxationDivisor(entries[kEntries - 1][node], others);
    inverseDivisor[i * nodesZ(g) + j] = isHeld(g, i, j) ? 0.0f : 1.0f / divisor;
}
