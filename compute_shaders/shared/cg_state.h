// cg_state.h - scalars of conjugate gradients, one set per load, and their use (GLSL and C++).
//
// Conjugate gradients gain gain_k = alpha_k (r_k, z_k) in the squared energy norm of the error with each step (Hestenes
// & Stiefel 1952), so error_k^2 = gain_k+1 + gain_k+2 + ... A geometric tail with the larger of the last two ratios
// estimates it without another step, and a share of a Gauss-Radau bound catches gains that are small by luck; see
// cg_step.h. The estimate is relative to the energy of the answer, (f, x).
#ifndef PALPATE_CG_STATE_H
#define PALPATE_CG_STATE_H

#ifdef __cplusplus
namespace palp::shared {
#endif

const int kStateWords    = 12; // numbers per load, of which one is not used
const int kStateRz       = 0; // (r, z)
const int kStateBeta     = 1; // of the next direction [1]
const int kStateAlpha    = 2; // of the next update [1]
const int kStateEnergy   = 3; // (f, x)
const int kStateGain     = 4; // of the last step
const int kStateEstimate = 5; // of the relative error in the energy norm [1]
const int kStateSteps    = 6; // steps since the count was last reset
const int kStateRatio    = 7; // largest recent ratio of a gain to the one before [1]
const int kStateSlowest  = 8; // see CgSlowest [1]
const int kStateLast     = 9;
const int kStateAlong    = 10;

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
