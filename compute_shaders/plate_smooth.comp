// plate_smooth.comp - one step of Chebyshev's iteration.
// Domain     one invocation per node; excess invocations return
// Reads      rigidity and foundation [1], inverse divisor [1], force of this level, deflection before this step; the
// deflection before
//            that, in the memory that is written, unless push.ahead is 0
// Writes     deflection
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { SmoothPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer Force { float force[]; };
layout(std430, binding = 3) readonly buffer Before { float before[]; };
layout(std430, binding = 4) buffer After { float after[]; };

int base;
float rigidity(int i, int j) { return D[i * nodesZ(push.level) + j]; }
float foundationShape(int i, int j) { return D[push.level.shapeAt + i * nodesZ(push.level) + j]; }
float deflection(int i, int j) { return before[base + i * nodesZ(push.level) + j]; }
float otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    base = firstOfLoad(g);
    int n = i * nodesZ(g) + j;
    float w = deflection(i, j);
    // The first step must not use the memory's old content, which may be NaN.
    float beforeThat = push.ahead == 0.0f ? w : after[base + n];
    // The inverse divisor of a held node is 0, so it stays where it is, at 0.
    after[base + n] = smoothed(w, beforeThat, force[base + n], operatorAt(g, i, j), inverseDivisor[n], push.ahead, push.step);
}
