// rigidity_levels.comp - rigidity and foundation of all coarser levels from the finest one's, in one dispatch.
// Domain     one workgroup along x and y per kOwnNodes x kOwnNodes nodes of the level kDeep levels below the finest, or
//            of the coarsest
// Reads      the levels; rigidity and foundation of the finest level [1]
// Writes     those of the coarser levels [1]
//
// A workgroup makes the levels down to its own nodes in shared memory, rims included that others make too, so that none
// needs another's numbers; of what it has made it writes the part that it owns. The workgroup that ends last goes on
// with the levels below, which are small, see cg_last_group.glsl. Numbers equal those of rigidity_coarsen.comp, to the
// bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/rigidity_level.h"

layout(push_constant) uniform Constants { RigidityPush push; };
layout(std430, binding = 0) readonly buffer Levels { RigidityLevel levels[]; };
layout(std430, binding = 1) readonly buffer Finest { float finest[]; };
layout(std430, binding = 2) coherent buffer Rigidity { float D[]; };
layout(std430, binding = 3) coherent buffer Tickets { uint tickets[]; };

#include "compute_shaders/cg_last_group.glsl"

// Nodes from .xy to .zw, both included.
shared float above[2 * kTopNodes * kTopNodes], below[2 * kTopNodes * kTopNodes]; // rigidity, then foundation

const int kFromFinest = 0, kFromAbove = 1, kFromLevel = 2;
int   source;
ivec4 span;      // of the nodes in `above`
int   fineField; // of the finer level
int   fineShapeAt, fineNodesZ;

float fineAt(int i, int j, int part)
{
    if (source == kFromAbove) return above[part * kTopNodes * kTopNodes + (i - span.x) * kTopNodes + (j - span.y)];
    int n = part * fineShapeAt + i * fineNodesZ + j;
    return source == kFromFinest ? finest[n] : D[fineField + n];
}
float fineRigidity(int i, int j) { return fineAt(i, j, 0); }
float fineShape(int i, int j) { return fineAt(i, j, 1); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/rigidity_coarsen.h"

// The nodes of the finer level that those from .xy to .zw of the coarser one are made of.
ivec4 neededFor(ivec4 nodes, PlateLevel fine, PlateLevel coarse)
{
    return ivec4(max(0, finePlace(nodes.x, fine.cellsX, coarse.cellsX) - 1),
                 max(0, finePlace(nodes.y, fine.cellsZ, coarse.cellsZ) - 1),
                 min(fine.cellsX, finePlace(nodes.z, fine.cellsX, coarse.cellsX) + 1),
                 min(fine.cellsZ, finePlace(nodes.w, fine.cellsZ, coarse.cellsZ) + 1));
}

// Those that a workgroup owns of the finer level: up to where the next one's begin.
ivec4 ownedAbove(ivec4 owned, PlateLevel fine, PlateLevel coarse)
{
    return ivec4(finePlace(owned.x, fine.cellsX, coarse.cellsX), finePlace(owned.y, fine.cellsZ, coarse.cellsZ),
                 owned.z == coarse.cellsX ? fine.cellsX : finePlace(owned.z + 1, fine.cellsX, coarse.cellsX) - 1,
                 owned.w == coarse.cellsZ ? fine.cellsZ : finePlace(owned.w + 1, fine.cellsZ, coarse.cellsZ) - 1);
}

bool isWithin(int i, int j, ivec4 nodes) { return i >= nodes.x && j >= nodes.y && i <= nodes.z && j <= nodes.w; }

// Makes these nodes of level l, writes those that are owned, and keeps all of them in `below` where they fit.
void makeNodes(int l, ivec4 nodes, ivec4 owned, bool keeps)
{
    PlateLevel from = levels[l - 1].plate, to = levels[l].plate;
    fineField = levels[l - 1].field;
    fineShapeAt = from.shapeAt;
    fineNodesZ = nodesZ(from);
    int field = levels[l].field, width = nodes.w - nodes.y + 1, count = (nodes.z - nodes.x + 1) * width;
    for (int n = int(gl_LocalInvocationIndex); n < count; n += int(lanesOfGroup())) {
        int  i = nodes.x + n / width, j = nodes.y + n % width, place = (i - nodes.x) * kTopNodes + (j - nodes.y);
        bool own = isWithin(i, j, owned);
        float rigidity = coarseRigidityAt(from, to, i, j);
        if (keeps) below[place] = rigidity;
        if (own) D[field + i * nodesZ(to) + j] = rigidity;
        if (to.shapeAt == 0) continue;
        float shape = coarseShapeAt(from, to, i, j);
        if (keeps) below[kTopNodes * kTopNodes + place] = shape;
        if (own) D[field + to.shapeAt + i * nodesZ(to) + j] = shape;
    }
    barrier();
}

void makeOwnLevels(int deepest)
{
    ivec4 nodes[kDeep + 1], owned[kDeep + 1];
    PlateLevel g = levels[deepest].plate;
    ivec2 first = kOwnNodes * ivec2(gl_WorkGroupID.yx);
    nodes[deepest] = ivec4(first, min(first + kOwnNodes - 1, ivec2(g.cellsX, g.cellsZ)));
    owned[deepest] = nodes[deepest];
    for (int l = deepest; l > 1; --l) {
        nodes[l - 1] = neededFor(nodes[l], levels[l - 1].plate, levels[l].plate);
        owned[l - 1] = ownedAbove(owned[l], levels[l - 1].plate, levels[l].plate);
    }
    [[dont_unroll]] for (int l = 1; l <= deepest; ++l) {
        source = l == 1 ? kFromFinest : kFromAbove;
        makeNodes(l, nodes[l], owned[l], l < deepest);
        span = nodes[l];
        for (int n = int(gl_LocalInvocationIndex); n < 2 * kTopNodes * kTopNodes; n += int(lanesOfGroup())) above[n] = below[n];
        barrier();
    }
}

void main()
{
    int last = int(push.levels) - 1, deepest = min(kDeep, last);
    makeOwnLevels(deepest);
    memoryBarrierBuffer(); // of what every invocation wrote
    barrier();
    if (!isLastGroup(0u)) return;
    memoryBarrierBuffer();
    source = kFromLevel;
    [[dont_unroll]] for (int l = deepest + 1; l <= last; ++l) {
        ivec4 all = ivec4(0, 0, levels[l].plate.cellsX, levels[l].plate.cellsZ);
        makeNodes(l, all, all, false);
        memoryBarrierBuffer();
        barrier();
    }
}
