// shell_add.comp - adds one vector of floats to another.
// Domain     x: numbers; z: loads
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellVectorPush push; };
layout(std430, binding = 0) readonly buffer Added { float added[]; };
layout(std430, binding = 1) buffer Sum { float sum[]; };

void main()
{
    uint n = gl_GlobalInvocationID.x;
    if (n >= push.numbers) return;
    n += uint(load()) * push.numbers;
    sum[n] += added[n];
}
