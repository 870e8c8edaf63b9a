// cg_load.glsl - what conjugate gradients keep of a load, written by one invocation.
//
// The includer declares  state,  a buffer of the numbers of all loads, see shared/cg_state.h, of which those of this
// load begin at `at`. begins is as in ScalarsPush.

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/cg_step.h"

void beginStep(int at, real rz, real fx, uint begins)
{
    bool anew = begins == 2u;
    state[at + kStateBeta]   = anew || state[at + kStateRz] == real(0.0f) ? real(0.0f) : rz / state[at + kStateRz];
    state[at + kStateRz]     = rz;
    state[at + kStateEnergy] = fx;
    if (begins != 0u) state[at + kStateSteps] = real(0.0f);
    if (anew) {
        state[at + kStateGain]  = real(0.0f);
        state[at + kStateRatio] = real(0.0f);
    }
}

CgStep nextStep(int at, real pq)
{
    CgSlowest slowest = CgSlowest(state[at + kStateSlowest], state[at + kStateLast], state[at + kStateAlong]);
    return stepOf(pq, state[at + kStateRz], state[at + kStateBeta], state[at + kStateEnergy], state[at + kStateAlpha],
                  state[at + kStateGain], state[at + kStateRatio], state[at + kStateSteps], slowest);
}

void keepStep(int at, CgStep now)
{
    state[at + kStateAlpha]    = now.alpha;
    state[at + kStateGain]     = now.gain;
    state[at + kStateRatio]    = now.ratio;
    state[at + kStateEstimate] = now.estimate;
    state[at + kStateSteps]    = now.steps;
    state[at + kStateSlowest]  = now.slowest.most;
    state[at + kStateLast]     = now.slowest.last;
    state[at + kStateAlong]    = now.slowest.along;
}
