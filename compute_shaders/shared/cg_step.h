// cg_step.h - the numbers of one step of conjugate gradients (GLSL and C++); include cg_state.h first.

struct CgStep {
    real alpha;    // [1]
    real gain;     // in the squared energy norm of the error
    real ratio;    // largest recent ratio of a gain to the one before [1]
    real estimate; // of the relative error in the energy norm after this step [1]
    real steps;    // steps done, this one included
};

// Largest ratio for which the geometric tail is used: beyond it a tail of twenty steps is assumed. A first step has no
// ratio: the remaining error is taken to be as large as the gain. Gains rise and fall where convergence is slow, so a
// ratio is forgotten by kMemory per step only. A single ratio may be lucky, as small grids with sharp discs have shown:
// below kSecondRatio it is not used. Where rounding leaves no positive pq no step is taken, and (r, z), which is about
// the squared error, estimates the rest. Constants have few binary digits, because compilers of shaders round a float
// in a double sum later than C++ does.
CgStep stepOf(real pq, real rz, real energy, real lastGain, real lastRatio, real steps)
{
    const real kMostRatio = real(0.953125f), kLeastRatio = real(0.0078125f), kFirstRatio = real(0.5f);
    const real kSecondRatio = real(0.09375f), kMemory = real(0.8125f);
    CgStep     now;
    now.alpha    = pq > real(0.0f) ? rz / pq : real(0.0f);
    now.gain     = now.alpha * rz;
    now.steps    = steps + real(1.0f);
    now.ratio    = lastGain > real(0.0f) ? max(now.gain / lastGain, kMemory * lastRatio) : real(0.0f);
    real rho     = steps == real(0.0f) && lastGain == real(0.0f) ? kFirstRatio : now.ratio;
    rho          = min(max(rho, lastRatio > real(0.0f) ? kLeastRatio : kSecondRatio), kMostRatio);
    real left    = pq > real(0.0f) ? now.gain * rho / (real(1.0f) - rho) : abs(rz);
    real all     = max(max(energy, real(0.0f)) + now.gain, left); // an estimate is at most 1
    now.estimate = all > real(0.0f) ? sqrt(left / all) : real(0.0f);
    return now;
}
