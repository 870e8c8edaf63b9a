// shell_advance.comp - a step of conjugate gradients of a shell: x += length p, r -= length q.
// Domain     x: numbers; z: loads
// Reads      directions and their products, lengths of each load
// Writes     answer, what is left of the right side, and the same in floats
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellVectorPush push; };
layout(std430, binding = 0) buffer Answer { double x[]; };
layout(std430, binding = 1) buffer Left { double r[]; };
layout(std430, binding = 2) readonly buffer Direction { double p[]; };
layout(std430, binding = 3) readonly buffer Product { double q[]; };
layout(std430, binding = 4) writeonly buffer Rounded { float rounded[]; };
layout(std430, binding = 5) readonly buffer Lengths { double lengths[]; };

void main()
{
    uint n = gl_GlobalInvocationID.x;
    if (n >= push.numbers) return;
    double by = lengths[load()];
    n += uint(load()) * push.numbers;
    double left = r[n] - by * q[n];
    x[n]        = x[n] + by * p[n];
    r[n]        = left;
    rounded[n]  = float(left);
}
