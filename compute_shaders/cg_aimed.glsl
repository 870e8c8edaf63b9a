// cg_aimed.glsl - the dot products that begin a step of conjugate gradients, from what each invocation has of them.
//
// The includer declares  partials,  a coherent buffer for two sums of each workgroup, and what cg_last_group.glsl and
// cg_load.glsl ask for.

#include "compute_shaders/cg_last_group.glsl"
#include "compute_shaders/cg_load.glsl"

// Writes the workgroup's sums of (r, z) and (f, x); the load's last workgroup makes beta of all of them.
void aim(uint load, real rz, real fx, uint begins)
{
    uint groups = groupsOfLoad();
    rz = sumOverGroup(rz);
    fx = sumOverGroup(fx);
    if (gl_LocalInvocationIndex == 0u) {
        partials[2u * (load * groups + groupOfLoad())]      = rz;
        partials[2u * (load * groups + groupOfLoad()) + 1u] = fx;
    }
    if (!isLastGroup(load)) return;
    rz = fx = real(0.0f);
    for (uint n = gl_LocalInvocationIndex; n < groups; n += lanesOfGroup()) {
        rz += partials[2u * (load * groups + n)];
        fx += partials[2u * (load * groups + n) + 1u];
    }
    rz = sumOverGroup(rz);
    fx = sumOverGroup(fx);
    if (gl_LocalInvocationIndex == 0u) beginStep(int(load) * kStateWords, rz, fx, begins);
}
