// coarse_assemble.comp - the coarsest level's matrix as a band, see coarse_band.h.
// Domain     x: offset from the diagonal, y: unknown
// Reads      rigidity of the coarsest level [1]
// Writes     columns of the lower triangle (real)
//
// Entries are the operator's answers to unit deflections, so that there is no second list of them.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/coarse_band.h"

layout(push_constant) uniform Constants { LevelPush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) writeonly buffer Band { real band[]; };

int unitI, unitJ;
real rigidity(int i, int j) { return real(D[i * nodesZ(push.level) + j]); }
real foundationShape(int i, int j) { return real(D[push.level.shapeAt + i * nodesZ(push.level) + j]); }
real deflection(int i, int j) { return i == unitI && j == unitJ ? real(1.0f) : real(0.0f); }
real otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"

void main()
{
    PlateLevel g = push.level;
    int offset = int(gl_GlobalInvocationID.x), column = int(gl_GlobalInvocationID.y), row = column + offset;
    int unknowns = nodesX(g) * nodesZ(g);
    if (offset > halfBand(g) || column >= unknowns) return;
    real entry = offset == 0 ? real(1.0f) : real(0.0f);
    int i = columnOf(g, row), j = rowOf(g, row);
    unitI = columnOf(g, column);
    unitJ = rowOf(g, column);
    if (row < unknowns && !isHeld(g, i, j) && !isHeld(g, unitI, unitJ))
        entry = abs(i - unitI) + abs(j - unitJ) <= 2 ? operatorAt(g, i, j) : real(0.0f);
    band[column * (halfBand(g) + 1) + offset] = entry;
}
