// prepare_end.comp - lists of the tiles in which the rigidity jumps, and the factor of the coarsest level, in one
// dispatch. Domain     one workgroup along x per level; those before the last list the tiles, the last one factors
// Reads      the levels; rigidity and foundation of all [1]; marks of the tiles
// Writes     per level number of marked tiles, then their indices; the coarsest level's matrix and its factor, see
//            coarse_factor.glsl (real); for the host per level the number of tiles, of the coarsest that of lost pivots
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/rigidity_level.h"
#include "compute_shaders/shared/tile_layout.h"

layout(push_constant) uniform Constants { RigidityPush push; };
layout(std430, binding = 0) readonly buffer Levels { RigidityLevel levels[]; };
layout(std430, binding = 1) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 2) readonly buffer Marks { uint marks[]; };
layout(std430, binding = 3) writeonly buffer Lists { uint lists[]; };
layout(std430, binding = 4) coherent buffer Band { real band[]; };
layout(std430, binding = 5) writeonly buffer Factor { real factor[]; };
layout(std430, binding = 6) writeonly buffer ForHost { uint forHost[]; };

RigidityLevel here;
int  unitI, unitJ;
real rigidity(int i, int j) { return real(D[here.field + i * nodesZ(here.plate) + j]); }
real foundationShape(int i, int j) { return real(D[here.field + here.plate.shapeAt + i * nodesZ(here.plate) + j]); }
real deflection(int i, int j) { return i == unitI && j == unitJ ? real(1.0f) : real(0.0f); }
real otherColour(int i, int j) { return deflection(i, j); }
uint markOf(int tile) { return marks[here.list + tile]; }
void put(uint place, uint word) { lists[here.list + int(place)] = word; }

#include "compute_shaders/coarse_factor.glsl"
#include "compute_shaders/jump_list.glsl"
#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"

const int kEntriesBelow = 7; // of a column of the matrix, from the diagonal on, that are not 0 everywhere

// Distances of the entry's row from its column along the longer side and the shorter one.
ivec2 apart(int entry) { return entry < 3 ? ivec2(0, entry) : entry < 6 ? ivec2(1, entry - 4) : ivec2(2, 0); }

// The matrix of coarse_assemble.comp.
void assemble()
{
    PlateLevel g = here.plate;
    int slots = halfBand(g) + 1, unknowns = nodesX(g) * nodesZ(g), shorter = shorterNodes(g);
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    for (int n = lane; n < unknowns * slots; n += lanes) band[n] = real(n % slots == 0 ? 1.0f : 0.0f);
    memoryBarrierBuffer();
    barrier();
    for (int n = lane; n < unknowns * kEntriesBelow; n += lanes) {
        ivec2 away = apart(n % kEntriesBelow);
        int column = n / kEntriesBelow, offset = away.x * shorter + away.y, row = column + offset;
        int beside = column % shorter + away.y;
        if (row >= unknowns || beside < 0 || beside >= shorter) continue;
        int i = columnOf(g, row), j = rowOf(g, row);
        unitI = columnOf(g, column);
        unitJ = rowOf(g, column);
        if (!isHeld(g, i, j) && !isHeld(g, unitI, unitJ)) band[column * slots + offset] = operatorAt(g, i, j);
    }
    memoryBarrierBuffer();
    barrier();
}

void main()
{
    int level = int(gl_WorkGroupID.x);
    here = levels[level];
    if (level + 1 < int(push.levels)) {
        uint count = listTiles(here.plate);
        if (gl_LocalInvocationIndex == gl_WorkGroupSize.x - 1u) {
            put(0u, count);
            forHost[level] = count;
        }
        return;
    }
    assemble();
    uint lost = factorBand(here.plate);
    if (gl_LocalInvocationIndex == 0u) forHost[level] = lost;
}
