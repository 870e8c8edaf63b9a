// plate_down.comp - the way down of a cycle on one level: sweeps from zero deflection, and the residual.
// Domain     one workgroup along x per kOwned x kOwned nodes, see plate_region.glsl; z: loads
// Reads      rigidity and foundation [1], inverse divisor [1], force of this level
// Writes     deflection and residual, 0 on held nodes
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require // unrolled sweeps take a driver seconds to compile

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer Force { float force[]; };
layout(std430, binding = 3) writeonly buffer Deflection { float w[]; };
layout(std430, binding = 4) writeonly buffer Residual { float residual[]; };

PlateLevel region() { return push.level; }

#include "compute_shaders/plate_region.glsl"

void main()
{
    startRegion();
    PlateLevel g = region();
    int lane = int(gl_LocalInvocationID.x);
    for (int n = lane; n < kRegion * kRegion; n += kLanes) { // the half sweep of colour 0 needs no operator
        int i = cornerI + n / kRegion, j = cornerJ + n % kRegion;
        if (isNode(i, j)) tile[n] = ((i + j) & 1) == 0 ? force[base + nodeAt(i, j)] * inverseDivisor[nodeAt(i, j)] : 0.0f;
    }
    barrier();
    [[dont_unroll]] for (int turn = 1; turn < 2 * kSweeps; ++turn) relaxRegion(uint(turn & 1), 2 * turn);
    for (int n = lane; n < kOwned * kOwned; n += kLanes) {
        int i = cornerI + kRim + n / kOwned, j = cornerJ + kRim + n % kOwned;
        if (isNode(i, j)) {
            int at = base + nodeAt(i, j);
            w[at] = deflection(i, j);
            residual[at] = isHeld(g, i, j) ? 0.0f : force[at] - operatorAt(g, i, j);
        }
    }
}
