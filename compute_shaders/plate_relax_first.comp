// plate_relax_first.comp - the half sweep of colour 0 from zero deflection, which needs no operator.
// Domain     one invocation per node of colour 0
// Reads      inverse divisor [1], force of this level
// Writes     deflection of nodes of colour 0
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { RelaxPush push; };
layout(std430, binding = 0) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 1) readonly buffer Force { float force[]; };
layout(std430, binding = 2) writeonly buffer After { float after[]; };

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y);
    int j = 2 * int(gl_GlobalInvocationID.x) + int((uint(i) + push.colour) & 1u);
    if (i > g.cellsX || j > g.cellsZ) return;
    int base = firstOfLoad(g), n = i * nodesZ(g) + j;
    after[base + n] = force[base + n] * inverseDivisor[n]; // 0 on held nodes
}
