// plate_tail.comp - a whole cycle on the coarse levels, from forces to deflection, by one workgroup per load.
// Domain     x: one workgroup; z: loads
// Reads      the levels (see tail_level.h), for all of them rigidity [1], inverse divisor [1] and transfer tables; the
//            inverse of the coarsest level's matrix, column after column (real); force of the first level
// Writes     deflection of the first level, 0 on held nodes; deflections put aside on the way down, each invocation its
//            own nodes'
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require // unrolled sweeps take a driver seconds to compile

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/tail_level.h"

layout(constant_id = 3) const int kSweeps = 2; // before and after the correction

layout(push_constant) uniform Constants { TailPush push; };
layout(std430, binding = 6) readonly buffer Force { float force[]; };
layout(std430, binding = 8) writeonly buffer Deflection { float w[]; };

float givenForce(int node);

#include "compute_shaders/plate_tail.glsl"

float givenForce(int node) { return force[load * nodesOf(here.plate) + node]; }

void main()
{
    load = int(gl_WorkGroupID.z);
    first = int(push.first);
    runCycle();
    int nodes = nodesOf(here.plate);
    for (int n = int(gl_LocalInvocationID.x); n < nodes; n += kLanes) w[load * nodes + n] = pool[here.w + n];
}
