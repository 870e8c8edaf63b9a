// shell_turn.comp - the next direction of conjugate gradients of a shell, p = z + beta p.
// Domain     x: numbers; z: loads
// Reads      what the cycle makes of the residual (float), and of each load beta and whether it turns at all
// Writes     direction, over the last one
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/shell_prelude.glsl"

layout(push_constant) uniform Constants { ShellVectorPush push; };
layout(std430, binding = 0) readonly buffer Preconditioned { float z[]; };
layout(std430, binding = 1) buffer Direction { double p[]; };
layout(std430, binding = 2) readonly buffer Turns { double turns[]; };

void main()
{
    uint n = gl_GlobalInvocationID.x;
    if (n >= push.numbers) return;
    double beta = turns[2 * load()];
    if (turns[2 * load() + 1] == 0.0) return;
    n += uint(load()) * push.numbers;
    p[n] = beta == 0.0 ? double(z[n]) : double(z[n]) + beta * p[n]; // before the first direction, p holds undefined memory
}
