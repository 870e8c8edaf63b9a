#version 460
#extension GL_GOOGLE_include_directive : require
// plane_smooth.comp - mean of a node and its neighbours along x, times scale; the ends see themselves.
// Domain     one invocation per node; rounded up to the workgroup, excess invocations return
// Reads      source [1]
// Writes     target [1]
// Variants   WRITE_PAST_END and MISS_LAST_COLUMN are mistakes that the guard bands must catch
#include "tests/shaders/plane_layout.h"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z_id = 2) in;
layout(constant_id = 3) const uint kBias = 0; // added to each value [1]
layout(push_constant) uniform Push { PlanePush pc; };
layout(set = 0, binding = 0) readonly buffer Source { float source[]; };
layout(set = 0, binding = 1) writeonly buffer Target { float target[]; };

void main()
{
    const uint x = gl_GlobalInvocationID.x;
    const uint y = gl_GlobalInvocationID.y;
#if defined(MISS_LAST_COLUMN)
    if (x >= pc.nx - 1 || y >= pc.ny) return;
#else
    if (x >= pc.nx || y >= pc.ny) return;
#endif
    const uint  row   = y * pc.nx;
    const float left  = source[row + (x > 0 ? x - 1 : x)];
    const float here  = source[row + x];
    const float right = source[row + (x + 1 < pc.nx ? x + 1 : x)];
    precise const float mean = (left + here + right) * (1.0 / 3.0);
    precise const float value = mean * pc.scale + float(kBias);
#if defined(WRITE_PAST_END)
    target[row + x + 1] = value;
    if (x == 0 && y == 0) target[0] = value;
#else
    target[row + x] = value;
#endif
}
