// cg_scalars.comp - completes the dot products, computes the numbers of a step, and stops a finished solve.
// Domain     one workgroup, of a power of two of invocations; loads one after the other
// Reads      partial sums (real), see cg_dot.comp; state of the loads (real), see cg_state.h
// Writes     state of the loads; with PALPATE_STEP, when every load is finished, zeroes to the arguments of the
//            indirect dispatches, so that everything recorded after this does nothing
#version 460
#extension GL_GOOGLE_include_directive : require

#include "compute_shaders/plate_prelude.glsl"

layout(push_constant) uniform Constants { ScalarsPush push; };
layout(std430, binding = 0) readonly buffer Partials { real partials[]; };
layout(std430, binding = 1) buffer State { real state[]; };
#ifdef PALPATE_STEP
layout(std430, binding = 2) writeonly buffer Arguments { uint arguments[]; };
#endif

#include "compute_shaders/cg_load.glsl"

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
        CgStep now = nextStep(at, pq);
        barrier(); // every invocation has read the state
        if (leads) keepStep(at, now);
        unfinished = unfinished || push.tolerance == 0.0f || now.estimate > real(push.tolerance);
#else
        real rz = total(2u * load * push.partials), fx = total((2u * load + 1u) * push.partials);
        if (leads) beginStep(at, rz, fx, push.begins);
#endif
    }
#ifdef PALPATE_STEP
    if (!unfinished)
        for (uint n = gl_LocalInvocationID.x; n < push.argumentWords; n += gl_WorkGroupSize.x) arguments[n] = 0u;
#endif
}
