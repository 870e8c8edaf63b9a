// plate_smooth_first.comp - the first step of Chebyshev's iteration from zero deflection, which needs no operator.
// Domain     one invocation per node; excess invocations return
// Reads      inverse divisor [1], force of this level
// Writes     deflection before, 0, and after
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { SmoothPush push; };
layout(std430, binding = 0) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 1) readonly buffer Force { float force[]; };
layout(std430, binding = 2) writeonly buffer Before { float before[]; };
layout(std430, binding = 3) writeonly buffer After { float after[]; };

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    int base = firstOfLoad(g), n = i * nodesZ(g) + j;
    before[base + n] = 0.0f;
    after[base + n] = push.step * (force[base + n] * inverseDivisor[n]); // 0 on held nodes
}
