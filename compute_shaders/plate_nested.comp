// plate_nested.comp - nested iteration on the coarse levels, from loads to a deflection, by one workgroup per load.
// Domain     x: one workgroup; z: loads
// Reads      as plate_tail.comp, with the load of the first level in place of its force
// Writes     deflection of the first level, 0 on held nodes; of all levels load, answer, residual and direction, and
// what is
//            put aside
//
// Loads are gathered downwards; the coarsest level is solved; then level by level upwards the answer is interpolated
// and takes a step of conjugate gradients, or push.steps on the first level. All but the coarsest level's sums is in
// floats: the answer begins the iteration on a finer level, whose residual is computed anew, so that its rounding costs
// no accuracy.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require // unrolled sweeps take a driver seconds to compile

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/tail_level.h"

const int kSweeps = kNestedSweeps;

layout(push_constant) uniform Constants { NestedPush push; };
layout(std430, binding = 6) readonly buffer Load { float given[]; };
layout(std430, binding = 8) writeonly buffer Deflection { float w[]; };
layout(std430, binding = 9) coherent buffer Loads { float f[]; };
layout(std430, binding = 10) buffer Answer { float x[]; };
layout(std430, binding = 11) coherent buffer Residual { float r[]; };
layout(std430, binding = 12) buffer Direction { float p[]; };

float givenForce(int node);

#include "compute_shaders/plate_tail.glsl"

// What the first level of a cycle, or an operator's result, is compared with.
const int kTheLoad = 0, kTheResidual = 1, kNothing = 2;
int       compared;

float givenForce(int node)
{
    int at = asideAt(node);
    return compared == kTheLoad ? f[at] : compared == kTheResidual ? r[at] : 0.0f;
}

shared float sums[kTailSums];

// Every invocation gets the sum of what each has; the order depends on the workgroup's size only.
float sumOverGroup(float value)
{
    int lane = int(gl_LocalInvocationID.x), place = lane % kTailSums;
    barrier(); // the last sum has been read
    if (lane < kTailSums) sums[place] = value;
    for (int turn = 1; turn < kLanes / kTailSums; ++turn) {
        barrier();
        if (lane / kTailSums == turn) sums[place] += value;
    }
    for (int reach = kTailSums / 2; reach > 0; reach /= 2) {
        barrier();
        if (lane < reach) sums[lane] += sums[lane + reach];
    }
    barrier();
    return sums[0];
}

// Ends a part in which each invocation wrote what others read.
void share()
{
    memoryBarrierBuffer();
    barrier();
}

// What is left of the compared forces by the pool's deflection, to the memory of what is put aside.
void putLeftAside()
{
    [[dont_unroll]] for (uint colour = 0u; colour < 2u; ++colour) treatColour(colour, false);
    share();
}

void gatherLoads(int last)
{
    enter(first);
    int nodes = nodesOf(here.plate);
    for (int n = int(gl_LocalInvocationID.x); n < nodes; n += kLanes)
        f[asideAt(n)] = pool[here.w + n] = given[load * nodes + n];
    share();
    [[dont_unroll]] for (int l = first; l < last; ++l) {
        enter(l);
        for (int n = int(gl_LocalInvocationID.x); n < nodesOf(below.plate); n += kLanes) {
            float gathered = restrictedAt(n / nodesZ(below.plate), n % nodesZ(below.plate), nodesX(here.plate),
                                          nodesZ(here.plate));
            f[load * int(push.nodes) + below.field + n] = gathered;
            pool[below.w + n] = gathered;
        }
        share();
    }
}

// Takes a step of conjugate gradients on the level where cycles begin; returns (r, z).
float takeStep(bool begins, float lastRz)
{
    compared = kTheResidual;
    runCycle();
    int nodes = nodesOf(here.plate), lane = int(gl_LocalInvocationID.x);
    float rz = 0.0f, pq = 0.0f;
    for (int n = lane; n < nodes; n += kLanes) rz += r[asideAt(n)] * pool[here.w + n];
    rz = sumOverGroup(rz);
    float beta = begins || lastRz == 0.0f ? 0.0f : rz / lastRz;
    for (int n = lane; n < nodes; n += kLanes) {
        float direction = pool[here.w + n] + (begins ? 0.0f : beta * p[asideAt(n)]);
        p[asideAt(n)] = direction;
        pool[here.w + n] = direction;
    }
    share();
    compared = kNothing;
    putLeftAside(); // of no force: -A p
    for (int n = lane; n < nodes; n += kLanes) pq -= p[asideAt(n)] * aside[asideAt(n)];
    pq = sumOverGroup(pq);
    float alpha = pq > 0.0f ? rz / pq : 0.0f;
    for (int n = lane; n < nodes; n += kLanes) {
        x[asideAt(n)] += alpha * p[asideAt(n)];
        r[asideAt(n)] += alpha * aside[asideAt(n)];
    }
    share();
    return rz;
}

void main()
{
    int top = int(push.first), last = int(push.levels) - 1, lane = int(gl_LocalInvocationID.x);
    load  = int(gl_WorkGroupID.z);
    first = top;
    gatherLoads(last);
    first = last;
    compared = kTheLoad;
    enter(last);
    solveCoarsest();
    [[dont_unroll]] for (int l = last - 1; l >= top; --l) {
        first = l;
        enter(l);
        int nodes = nodesOf(here.plate);
        for (int n = lane; n < nodes; n += kLanes)
            x[asideAt(n)] = pool[here.w + n] = prolongedAt(n / nodesZ(here.plate), n % nodesZ(here.plate));
        share();
        compared = kTheLoad;
        putLeftAside();
        for (int n = lane; n < nodes; n += kLanes) r[asideAt(n)] = aside[asideAt(n)];
        share();
        int   steps = l == top ? int(push.steps) : 1;
        float rz    = 0.0f;
        [[dont_unroll]] for (int step = 0; step < steps; ++step) rz = takeStep(step == 0, rz);
        for (int n = lane; n < nodes; n += kLanes) pool[here.w + n] = x[asideAt(n)];
        barrier();
    }
    int nodes = nodesOf(here.plate);
    for (int n = lane; n < nodes; n += kLanes) w[load * nodes + n] = pool[here.w + n];
}
