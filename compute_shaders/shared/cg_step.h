// cg_step.h - the numbers of one step of conjugate gradients (GLSL and C++); include cg_state.h first.

// Compilers of shaders may reorder products with constants, unless they are told not to.
#ifdef __cplusplus
#define PALPATE_IN_ORDER
#else
#define PALPATE_IN_ORDER precise
#endif

// The slowest part of the error that the steps have met: 1 over the smallest Ritz value. The matrix of Lanczos' method
// is R'R with R bidiagonal, of alphas and betas; the largest eigenvalue of (R'R)^-1 grows with each column of R^-1, and
// the vector that gives it is kept by its products with the last column alone.
struct CgSlowest {
    real most;  // 1 over the smallest Ritz value, from below [1]
    real last;  // square of the last column of R^-1
    real along; // product of R^-1 times the kept vector and the last column
};

struct CgStep {
    real alpha;    // [1]
    real gain;     // in the squared energy norm of the error
    real ratio;    // largest recent ratio of a gain to the one before [1]
    real estimate; // of the relative error in the energy norm after this step [1]
    real steps;    // steps done, this one included
    CgSlowest slowest;
};

// Source   Meurant & Tichy 2019, "Approximating the extreme Ritz values and upper bounds for the A-norm of the error in
//          CG", section 4; Duintjer Tebbens & Tuma 2014 (incremental norms)
CgSlowest slowestAfter(CgSlowest before, real alpha, real beta, real lastAlpha)
{
    CgSlowest now;
    bool first = !(beta > real(0.0f) && lastAlpha > real(0.0f));
    real fall  = first ? real(0.0f) : beta / lastAlpha;
    now.last   = first ? alpha : alpha * (fall * before.last + real(1.0f));
    real across = first ? real(0.0f) : sqrt(alpha * fall) * abs(before.along); // a column's sign is ours to choose
    real most   = first ? real(0.0f) : before.most;
    real apart  = most - now.last;
    real width  = sqrt(apart * apart + real(4.0f) * across * across);
    real share  = width > real(0.0f) ? real(0.5f) - real(0.5f) * (apart / width) : real(1.0f); // of the new column
    share       = min(max(share, real(0.0f)), real(1.0f));
    now.most    = most + width * share;
    now.along   = sqrt(real(1.0f) - share) * across + sqrt(share) * now.last;
    return now;
}

// What is left after a step, in the squared energy norm, at most; by Gauss-Radau quadrature with a node at 64/91 of the
// smallest Ritz value, and for conjugate gradients that began one step before: rules that begin with the first step
// need a Ritz value that has settled, or turn negative.
//
// Source   Meurant & Tichy 2023, "The behaviour of the Gauss-Radau upper bound of the error norm in CG"
// Differs  the rule is that of the last two steps, see above
real leftAtMost(CgSlowest slowest, real alpha, real beta, real lastAlpha, real rz)
{
    PALPATE_IN_ORDER real atNode = slowest.most * real(1.421875f);
    PALPATE_IN_ORDER real rest   = atNode - lastAlpha;
    PALPATE_IN_ORDER real within = rest / (rest / atNode + beta);
    PALPATE_IN_ORDER real bound  = (beta > real(0.0f) && lastAlpha > real(0.0f) ? within : atNode) - alpha;
    PALPATE_IN_ORDER real left   = max(bound, real(0.0f)) * rz;
    return left;
}

// Largest ratio for which the geometric tail is used: beyond it a tail of twenty steps is assumed. A first step has no
// ratio: the remaining error is taken to be as large as the gain. Gains rise and fall where convergence is slow, so a
// ratio is forgotten by kMemory per step only. A single ratio may be lucky, as small grids with sharp discs have shown:
// below kSecondRatio it is not used. Where rounding leaves no positive pq no step is taken, and (r, z), which is about
// the squared error, estimates the rest.
//
// The tail is right where the ratio is steady, and too small by a factor of up to 5.5 in the error where a stiff or
// soft disc hides a slow part (25 discs, hinges and smooth maps, 3 sizes, two smoothers, 1728 stops). The bound never
// is, but it is 3.5 times too large at the median and costs 14 % more steps. Of kBoundShare of the bound and the tail
// the larger one is at most 2.3 times too small, and costs 8 %. Constants have few binary digits, because compilers of
// shaders round a float in a double sum later than C++ does.
CgStep stepOf(real pq, real rz, real beta, real energy, real lastAlpha, real lastGain, real lastRatio, real steps,
              CgSlowest slowest)
{
    const real kMostRatio = real(0.953125f), kLeastRatio = real(0.0078125f), kFirstRatio = real(0.5f);
    const real kSecondRatio = real(0.09375f), kMemory = real(0.8125f), kBoundShare = real(0.40625f);
    CgStep     now;
    now.alpha    = pq > real(0.0f) ? rz / pq : real(0.0f);
    now.gain     = now.alpha * rz;
    now.steps    = steps + real(1.0f);
    now.ratio    = lastGain > real(0.0f) ? max(now.gain / lastGain, kMemory * lastRatio) : real(0.0f);
    now.slowest  = slowest;
    real rho     = steps == real(0.0f) && lastGain == real(0.0f) ? kFirstRatio : now.ratio;
    rho          = min(max(rho, lastRatio > real(0.0f) ? kLeastRatio : kSecondRatio), kMostRatio);
    PALPATE_IN_ORDER real left = abs(rz);
    if (pq > real(0.0f)) {
        now.slowest = slowestAfter(slowest, now.alpha, beta, lastAlpha);
        left        = max(now.gain * rho / (real(1.0f) - rho),
                          kBoundShare * leftAtMost(now.slowest, now.alpha, beta, lastAlpha, rz));
    }
    real all     = max(max(energy, real(0.0f)) + now.gain, left); // an estimate is at most 1
    now.estimate = all > real(0.0f) ? sqrt(left / all) : sqrt(abs(rz)); // 0 without a load; NaN is no answer
    return now;
}

#undef PALPATE_IN_ORDER
