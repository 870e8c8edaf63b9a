// cg_scalars.comp - completes the dot products, computes the numbers of a step, and stops a finished solve.
// Domain     one workgroup, of a power of two of invocations; loads one after the other
// Reads      partial sums (real), see cg_dot.comp; state of the loads (real), see cg_state.h
// Writes     state of the loads; with PALPATE_STEP, when every load is finished, zeroes to the arguments of the
//            indirect dispatches, so that everything recorded after this does nothing
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"
#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/cg_step.h"

layout(push_constant) uniform Constants { ScalarsPush push; };
layout(std430, binding = 0) readonly buffer Partials { real partials[]; };
layout(std430, binding = 1) buffer State { real state[]; };
#ifdef PALPATE_STEP
layout(std430, binding = 2) writeonly buffer Arguments { uint arguments[]; };
#endif

const int kMostInvocations = 256; // of this workgroup
shared real sums[kMostInvocations];

// Every invocation gets the sum of the numbers at first, first + 1, ...; the order depends on the workgroup's size
// only.
real total(uint first)
{
    uint t = gl_LocalInvocationID.x, width = gl_WorkGroupSize.x;
    real sum = real(0.0f);
    for (uint n = t; n < push.partials; n += width) sum += partials[first + n];
    barrier(); // the last total has been read
    sums[t] = sum;
    for (uint step = width / 2u; step > 0u; step /= 2u) {
        barrier();
        if (t < step) sums[t] += sums[t + step];
    }
    barrier();
    return sums[0];
}

void main()
{
    bool leads = gl_LocalInvocationID.x == 0u;
    bool unfinished = false;
    for (uint load = 0u; load < push.loads; ++load) {
        int at = int(load) * kStateWords;
#ifdef PALPATE_STEP
        real pq = total(load * push.partials);
        CgSlowest slowest = CgSlowest(state[at + kStateSlowest], state[at + kStateLast], state[at + kStateAlong]);
        CgStep now = stepOf(pq, state[at + kStateRz], state[at + kStateBeta], state[at + kStateEnergy],
                            state[at + kStateAlpha], state[at + kStateGain], state[at + kStateRatio],
                            state[at + kStateSteps], slowest);
        barrier(); // every invocation has read the state
        if (leads) {
            state[at + kStateAlpha]    = now.alpha;
            state[at + kStateGain]     = now.gain;
            state[at + kStateRatio]    = now.ratio;
            state[at + kStateEstimate] = now.estimate;
            state[at + kStateSteps]    = now.steps;
            state[at + kStateSlowest]  = now.slowest.most;
            state[at + kStateLast]     = now.slowest.last;
            state[at + kStateAlong]    = now.slowest.along;
        }
        unfinished = unfinished || push.tolerance == 0.0f || now.estimate > real(push.tolerance);
#else
        real rz = total(2u * load * push.partials), fx = total((2u * load + 1u) * push.partials);
        if (leads) {
            bool anew = push.begins == 2u;
            state[at + kStateBeta]   = anew || state[at + kStateRz] == real(0.0f) ? real(0.0f) : rz / state[at + kStateRz];
            state[at + kStateRz]     = rz;
            state[at + kStateEnergy] = fx;
            if (push.begins != 0u) state[at + kStateSteps] = real(0.0f);
            if (anew) {
                state[at + kStateGain]  = real(0.0f);
                state[at + kStateRatio] = real(0.0f);
            }
        }
#endif
    }
#ifdef PALPATE_STEP
    if (!unfinished)
        for (uint n = gl_LocalInvocationID.x; n < push.argumentWords; n += gl_WorkGroupSize.x) arguments[n] = 0u;
#endif
}
