// cg_probe.comp - the next direction of conjugate gradients, its forces, and how far to go along it, in one dispatch.
// Domain     one invocation per node, workgroups of a power of two of them; z: loads
// Reads      rigidity and foundation [1], preconditioned residual z (float), last direction (real), state with beta
// (real) Writes     direction p = z + beta p (real), forces q = A p (real), 0 on held nodes; sums of the workgroups of
// (p, q)
//            (real); state of the load; when every load is finished, zeroes to the arguments of the indirect
//            dispatches, so that everything recorded after this does nothing
//
// An invocation needs the direction of 13 nodes and computes it anew for each, so that the new one goes to a memory of
// its own. Behind the loads' tickets stand two more words: loads that are done with this dispatch, and those of them
// that are not finished.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { ProbePush push; };
layout(std430, binding = 0) readonly buffer Rigidity { float D[]; };
layout(std430, binding = 1) readonly buffer Preconditioned { float z[]; };
layout(std430, binding = 2) readonly buffer Last { real last[]; };
layout(std430, binding = 3) writeonly buffer Direction { real p[]; };
layout(std430, binding = 4) writeonly buffer Forces { real q[]; };
layout(std430, binding = 5) coherent buffer Partials { real partials[]; };
layout(std430, binding = 6) coherent buffer Tickets { uint tickets[]; };
layout(std430, binding = 7) buffer State { real state[]; };
layout(std430, binding = 8) writeonly buffer Arguments { uint arguments[]; };

#include "compute_shaders/cg_last_group.glsl"
#include "compute_shaders/cg_load.glsl"

int  base;
real beta;
real rigidity(int i, int j) { return real(D[i * nodesZ(push.level) + j]); }
real foundationShape(int i, int j) { return real(D[push.level.shapeAt + i * nodesZ(push.level) + j]); }
real deflection(int i, int j)
{
    int n = base + i * nodesZ(push.level) + j;
    return beta == real(0.0f) ? real(z[n]) : real(z[n]) + beta * last[n]; // the first last one is undefined memory
}
real otherColour(int i, int j) { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"

// Returns, in the one workgroup that is the last of all loads, whether all of them are finished; else false.
bool isAllFinished(bool unfinished)
{
    if (unfinished) atomicAdd(tickets[push.loads + 1u], 1u);
    memoryBarrierBuffer();
    if (atomicAdd(tickets[push.loads], 1u) + 1u != push.loads) return false;
    memoryBarrierBuffer();
    atomicExchange(tickets[push.loads], 0u);
    return atomicExchange(tickets[push.loads + 1u], 0u) == 0u;
}

shared bool stops;

void main()
{
    PlateLevel g = push.level;
    uint load = gl_GlobalInvocationID.z, groups = groupsOfLoad();
    int i = int(gl_GlobalInvocationID.y), j = int(gl_GlobalInvocationID.x), at = int(load) * kStateWords;
    base = firstOfLoad(g);
    beta = state[at + kStateBeta];
    real pq = real(0.0f);
    if (i <= g.cellsX && j <= g.cellsZ) {
        int  n = base + i * nodesZ(g) + j;
        real direction = deflection(i, j), force = isHeld(g, i, j) ? real(0.0f) : operatorAt(g, i, j);
        p[n] = direction;
        q[n] = force;
        pq   = direction * force;
    }
    pq = sumOverGroup(pq);
    if (gl_LocalInvocationIndex == 0u) partials[load * groups + groupOfLoad()] = pq;
    if (!isLastGroup(load)) return;
    pq = real(0.0f);
    for (uint n = gl_LocalInvocationIndex; n < groups; n += lanesOfGroup()) pq += partials[load * groups + n];
    pq = sumOverGroup(pq);
    if (gl_LocalInvocationIndex == 0u) {
        CgStep now = nextStep(at, pq);
        keepStep(at, now);
        stops = isAllFinished(push.tolerance == 0.0f || now.estimate > real(push.tolerance));
    }
    barrier();
    if (stops)
        for (uint n = gl_LocalInvocationIndex; n < push.argumentWords; n += lanesOfGroup()) arguments[n] = 0u;
}
