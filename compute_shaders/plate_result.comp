// plate_result.comp - the answer in metres, where the host reads it.
// Domain     x: one invocation per node; z: loads
// Reads      answer (real), metres per unit of each load (float)
// Writes     deflection [m]
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { VectorPush push; };
layout(std430, binding = 0) readonly buffer Answer { real x[]; };
layout(std430, binding = 1) readonly buffer Unit { float metres[]; };
layout(std430, binding = 2) writeonly buffer Deflection { float w[]; };

void main()
{
    uint load = gl_GlobalInvocationID.z, n = gl_GlobalInvocationID.x;
    if (n >= push.nodes) return;
    w[load * push.nodes + n] = float(x[load * push.nodes + n]) * metres[load];
}
