#version 460
#extension GL_GOOGLE_include_directive : require
// layout_echo.comp - writes every field of a push-constant struct back, one word each in the order of declaration.
// Domain     one invocation
// Reads      pc
// Writes     bits of the fields
#include "tests/shaders/echo_layout.h"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z_id = 2) in;
layout(push_constant) uniform Push { EchoPush pc; };
layout(set = 0, binding = 0) writeonly buffer Words { uint words[]; };

void main()
{
    if (gl_GlobalInvocationID.x + gl_GlobalInvocationID.y > 0) return;
    words[0] = pc.columns;
    words[1] = floatBitsToUint(pc.spacing);
    words[2] = pc.rows;
    words[3] = floatBitsToUint(pc.offset);
    words[4] = uint(pc.shift);
}
