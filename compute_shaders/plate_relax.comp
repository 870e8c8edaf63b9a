// plate_relax.comp - half a sweep of red-black relaxation of the plate.
// Domain     one invocation per node of one colour: column i, every second row; excess invocations return
// Reads      rigidity and foundation [1], inverse divisor [1], force of this level, deflection: nodes of the colour
// from before this
//            half sweep, the others from after the last one
// Writes     deflection of nodes of push.colour, and nothing else
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { RelaxPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 2) readonly buffer Force { float force[]; };
layout(std430, binding = 3) readonly buffer Same { float same[]; };
layout(std430, binding = 4) readonly buffer Other { float other[]; };
layout(std430, binding = 5) writeonly buffer After { float after[]; };

int base;
float rigidity(int i, int j) { return D[i * nodesZ(push.level) + j]; }
float foundationShape(int i, int j) { return D[push.level.shapeAt + i * nodesZ(push.level) + j]; }
float deflection(int i, int j) { return same[base + i * nodesZ(push.level) + j]; }
float otherColour(int i, int j) { return other[base + i * nodesZ(push.level) + j]; }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y);
    int j = 2 * int(gl_GlobalInvocationID.x) + int((uint(i) + push.colour) & 1u);
    if (i > g.cellsX || j > g.cellsZ) return;
    base = firstOfLoad(g);
    int n = i * nodesZ(g) + j;
    // The inverse divisor of a held node is 0, so it stays where it is, at 0.
    after[base + n] = relaxed(deflection(i, j), force[base + n], operatorAt(g, i, j), inverseDivisor[n]);
}
