// divisor_levels.comp - inverse divisors of all levels but the coarsest, and tiles in which their rigidities jump, in
// one dispatch.
// Domain     x, y: nodes, y over the rows of all levels, then over their rows of tiles; workgroups are one row high;
//            z: as in plate_divisor.comp; a workgroup of tiles marks each of as many as there are workgroups along x
// Reads      the levels; rigidity and foundation of all [1]
// Writes     1/divisor [1], 0 on held nodes; 1 for a tile with a jump, else 0
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/rigidity_level.h"
#include "compute_shaders/shared/tile_layout.h"

layout(push_constant) uniform Constants { RigidityPush push; };
layout(std430, binding = 0) readonly buffer Levels { RigidityLevel levels[]; };
layout(std430, binding = 1) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 2) writeonly buffer Divisor { float inverseDivisor[]; };
layout(std430, binding = 3) writeonly buffer Marks { uint marks[]; };

RigidityLevel here;
int   unitI, unitJ;
float rigidity(int i, int j) { return D[here.field + i * nodesZ(here.plate) + j]; }
float foundationShape(int i, int j) { return D[here.field + here.plate.shapeAt + i * nodesZ(here.plate) + j]; }
float deflection(int i, int j) { return i == unitI && j == unitJ ? 1.0f : 0.0f; }
float otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/jump_tiles.h"
#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
#include "compute_shaders/shared/plate_divisor.h"

const int kMostNodes = 28; // of a workgroup, as in plate_divisor.comp
shared float entries[kEntries][kMostNodes];

shared uint jumps;

// Marks tiles of a row, each by the whole workgroup: one invocation would wait for a hundred nodes one after the other.
void markTiles(int row)
{
    int l = 0;
    while (row >= levels[l + 1].tileRow) ++l;
    here = levels[l];
    int i = row - here.tileRow;
    for (int j = int(gl_WorkGroupID.x); j < tilesZ(here.plate); j += int(gl_NumWorkGroups.x)) {
        if (gl_LocalInvocationIndex == 0u) jumps = 0u;
        barrier();
        for (int n = int(gl_LocalInvocationIndex); n < kNodesAbout; n += int(gl_WorkGroupSize.x * gl_WorkGroupSize.z))
            if (jumpsAtNth(here.plate, i, j, n)) atomicOr(jumps, 1u);
        barrier();
        if (gl_LocalInvocationIndex == 0u) marks[here.list + i * tilesZ(here.plate) + j] = jumps;
    }
}

void main()
{
    int row = int(gl_WorkGroupID.y);
    if (row >= int(push.rows)) { // the whole workgroup
        markTiles(row - int(push.rows));
        return;
    }
    int l = 0;
    while (row >= levels[l + 1].row) ++l;
    here = levels[l];
    PlateLevel g = here.plate;
    int i = row - here.row, j = int(gl_GlobalInvocationID.x);
    int m = int(gl_LocalInvocationID.z), node = int(gl_LocalInvocationID.x);
    bool inside = j <= g.cellsZ;
    entries[m][node] = inside ? entryOf(g, i, j, m) : 0.0f;
    barrier();
    if (!inside || m > 0) return;
    float others = 0.0f;
    for (int n = 0; n < kEntries - 1; ++n) others += entries[n][node];
    float divisor = relaxationDivisor(entries[kEntries - 1][node], others);
    inverseDivisor[here.field + i * nodesZ(g) + j] = isHeld(g, i, j) ? 0.0f : 1.0f / divisor;
}
