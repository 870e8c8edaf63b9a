// plate_apply.comp - nodal forces of a deflection, A p.
// Domain     one invocation per node
// Reads      rigidity and foundation [1], deflection (real)
// Writes     forces (real), 0 on held nodes
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Deflection { real w[]; };
layout(std430, binding = 2) writeonly buffer Forces { real forces[]; };

int base;
real rigidity(int i, int j) { return real(D[i * nodesZ(push.level) + j]); }
real foundationShape(int i, int j) { return real(D[push.level.shapeAt + i * nodesZ(push.level) + j]); }
real deflection(int i, int j) { return w[base + i * nodesZ(push.level) + j]; }
real otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"

void main()
{
    PlateLevel g = push.level;
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x);
    if (i > g.cellsX || j > g.cellsZ) return;
    base = firstOfLoad(g);
    forces[base + i * nodesZ(g) + j] = isHeld(g, i, j) ? real(0.0f) : operatorAt(g, i, j);
}
