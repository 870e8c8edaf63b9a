// plate_relax_mistaken.comp - plate_relax.comp with mistakes that its test must catch; without any it is the same.
// Variants   STALE_OTHER_COLOUR  nodes of the other colour from before the last half sweep
//            NEW_SAME_COLOUR     nodes of the same colour from the buffer of the other one
//            MISS_LAST_COLUMN    the last column is not relaxed
//            WRITE_BOTH_COLOURS  nodes of the other colour are copied, not left alone
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
#ifdef NEW_SAME_COLOUR
float deflection(int i, int j) { return other[base + i * nodesZ(push.level) + j]; }
#else
float deflection(int i, int j) { return same[base + i * nodesZ(push.level) + j]; }
#endif
#ifdef STALE_OTHER_COLOUR
float otherColour(int i, int j) { return same[base + i * nodesZ(push.level) + j]; }
#else
float otherColour(int i, int j) { return other[base + i * nodesZ(push.level) + j]; }
#endif

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y);
    int j = 2 * int(gl_GlobalInvocationID.x) + int((uint(i) + push.colour) & 1u);
#ifdef MISS_LAST_COLUMN
    if (i >= g.cellsX || j > g.cellsZ) return;
#else
    if (i > g.cellsX || j > g.cellsZ) return;
#endif
    base = firstOfLoad(g);
    int n = i * nodesZ(g) + j;
#ifdef WRITE_BOTH_COLOURS
    if (j > 0) after[base + n - 1] = other[base + n - 1];
#endif
    after[base + n] = relaxed(deflection(i, j), force[base + n], operatorAt(g, i, j), inverseDivisor[n]);
}
