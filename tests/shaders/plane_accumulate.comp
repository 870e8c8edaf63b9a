#version 460
#extension GL_GOOGLE_include_directive : require
// plane_accumulate.comp - sum += scale * source, in place: two in a row only agree with C++ if the first is finished.
// Domain     one invocation per node
// Reads      source, sum [1]
// Writes     sum [1]
#include "tests/shaders/plane_layout.h"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z_id = 2) in;
layout(push_constant) uniform Push { PlanePush pc; };
layout(set = 0, binding = 0) readonly buffer Source { float source[]; };
layout(set = 0, binding = 1) buffer Sum { float sum[]; };

void main()
{
    const uint x = gl_GlobalInvocationID.x;
    const uint y = gl_GlobalInvocationID.y;
    if (x >= pc.nx || y >= pc.ny) return;
    const uint n = y * pc.nx + x;
    precise const float added = source[n] * pc.scale;
    precise const float total = sum[n] + added;
    sum[n] = total;
}
