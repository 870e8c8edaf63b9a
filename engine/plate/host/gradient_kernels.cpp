#include "engine/plate/host/frame.h"

// Conjugate gradients: cg_dot.comp, cg_scalars.comp, cg_direction.comp, cg_update.comp and plate_result.comp.

namespace palp::PALPATE_ISA {
namespace {

template <class Real>
struct Scalars {
    using real = Real;
#include "compute_shaders/shared/cg_step.h"
};

/// Computes partial sum t of the terms t, t + partials, ...: a row of partial sums grows by a row of terms at a time.
template <class Real, class Term>
void addTerms(std::ptrdiff_t nodes, std::ptrdiff_t partials, Real* sums, const Term& term)
{
    for (std::ptrdiff_t t = 0; t < partials; ++t) sums[t] = 0;
    for (std::ptrdiff_t first = 0; first < nodes; first += partials) {
        const std::ptrdiff_t count = nodes - first < partials ? nodes - first : partials;
#pragma GCC ivdep
        for (std::ptrdiff_t t = 0; t < count; ++t) sums[t] += term(first + t);
    }
}

/// Completes the partial sums in the order of a workgroup of this width.
template <class Real>
Real total(const Real* partials, uint count, uint width)
{
    Real sums[1024];
    for (uint t = 0; t < width; ++t) sums[t] = 0;
    for (uint first = 0; first < count; first += width)
        for (uint t = 0; t < width && first + t < count; ++t) sums[t] += partials[first + t];
    for (uint step = width / 2; step > 0; step /= 2)
        for (uint t = 0; t < step; ++t) sums[t] += sums[t + step];
    return sums[0];
}

template <class Real>
void dotsOf(const HostDispatch& d)
{
    const auto& push = pushed<VectorPush>(d);
    auto*       sums = bound<Real>(d, 4);
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const std::ptrdiff_t base = load * push.nodes;
        const auto*          r    = bound<const Real>(d, 0) + base;
        const auto*          z    = bound<const float>(d, 1) + base;
        const auto*          x    = bound<const Real>(d, 2) + base;
        const auto*          f    = bound<const float>(d, 3) + base;
        addTerms(push.nodes, push.partials, sums + 2 * load * push.partials,
                 [=](std::ptrdiff_t n) { return r[n] * Real(z[n]); });
        addTerms(push.nodes, push.partials, sums + (2 * load + 1) * push.partials,
                 [=](std::ptrdiff_t n) { return Real(f[n]) * x[n]; });
    }
}

template <class Real>
void stepDotsOf(const HostDispatch& d)
{
    const auto& push = pushed<VectorPush>(d);
    auto*       sums = bound<Real>(d, 2);
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const auto* p = bound<const Real>(d, 0) + load * push.nodes;
        const auto* q = bound<const Real>(d, 1) + load * push.nodes;
        addTerms(push.nodes, push.partials, sums + load * push.partials, [=](std::ptrdiff_t n) { return p[n] * q[n]; });
    }
}

template <class Real>
void betaOf(const HostDispatch& d)
{
    const auto& push     = pushed<ScalarsPush>(d);
    const auto* partials = bound<const Real>(d, 0);
    auto*       state    = bound<Real>(d, 1);
    for (uint load = 0; load < push.loads; ++load) {
        Real* const at   = state + std::ptrdiff_t(load) * kStateWords;
        const Real  rz   = total(partials + 2 * std::ptrdiff_t(load) * push.partials, push.partials, d.workgroup.x);
        const bool  anew = push.begins == 2;
        at[kStateBeta]   = anew || at[kStateRz] == 0 ? Real(0) : rz / at[kStateRz];
        at[kStateRz]     = rz;
        at[kStateEnergy] =
            total(partials + (2 * std::ptrdiff_t(load) + 1) * push.partials, push.partials, d.workgroup.x);
        if (push.begins != 0) at[kStateSteps] = 0;
        if (anew) at[kStateGain] = at[kStateRatio] = 0;
    }
}

template <class Real>
void stepOf(const HostDispatch& d)
{
    const auto& push       = pushed<ScalarsPush>(d);
    const auto* partials   = bound<const Real>(d, 0);
    auto*       state      = bound<Real>(d, 1);
    auto*       arguments  = bound<uint>(d, 2);
    bool        unfinished = false;
    for (uint load = 0; load < push.loads; ++load) {
        Real* const at     = state + std::ptrdiff_t(load) * kStateWords;
        const Real  pq     = total(partials + std::ptrdiff_t(load) * push.partials, push.partials, d.workgroup.x);
        const auto  now    = Scalars<Real>{}.stepOf(pq, at[kStateRz], at[kStateEnergy], at[kStateGain], at[kStateRatio],
                                                    at[kStateSteps]);
        at[kStateAlpha]    = now.alpha;
        at[kStateGain]     = now.gain;
        at[kStateRatio]    = now.ratio;
        at[kStateEstimate] = now.estimate;
        at[kStateSteps]    = now.steps;
        unfinished         = unfinished || push.tolerance == 0 || now.estimate > Real(push.tolerance);
    }
    if (unfinished) return;
    for (uint n = 0; n < push.argumentWords; ++n) arguments[n] = 0;
}

template <class Real>
void directionOf(const HostDispatch& d)
{
    const auto&          push  = pushed<VectorPush>(d);
    const auto*          state = bound<const Real>(d, 0);
    const std::ptrdiff_t nodes = push.nodes;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const Real  beta = state[load * kStateWords + kStateBeta];
        const auto* z    = bound<const float>(d, 1) + load * nodes;
        auto*       p    = bound<Real>(d, 2) + load * nodes;
        if (beta == 0)
            for (std::ptrdiff_t n = 0; n < nodes; ++n) p[n] = Real(z[n]);
        else
#pragma GCC ivdep
            for (std::ptrdiff_t n = 0; n < nodes; ++n) p[n] = Real(z[n]) + beta * p[n];
    }
}

template <class Real>
void updateOf(const HostDispatch& d)
{
    const auto&          push  = pushed<VectorPush>(d);
    const auto*          state = bound<const Real>(d, 0);
    const std::ptrdiff_t nodes = push.nodes;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        if (state[load * kStateWords + kStateSteps] != Real(float(push.iteration))) continue;
        const Real  alpha   = state[load * kStateWords + kStateAlpha];
        const auto* p       = bound<const Real>(d, 1) + load * nodes;
        const auto* q       = bound<const Real>(d, 2) + load * nodes;
        auto*       x       = bound<Real>(d, 3) + load * nodes;
        auto*       r       = bound<Real>(d, 4) + load * nodes;
        auto*       rounded = bound<float>(d, 5) + load * nodes;
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < nodes; ++n) {
            x[n] += alpha * p[n];
            const Real left = r[n] - alpha * q[n];
            r[n]            = left;
            rounded[n]      = float(left);
        }
    }
}

template <class Real>
void resultOf(const HostDispatch& d)
{
    const std::ptrdiff_t nodes = pushed<VectorPush>(d).nodes;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const auto* x      = bound<const Real>(d, 0) + load * nodes;
        const float metres = bound<const float>(d, 1)[load];
        auto*       w      = bound<float>(d, 2) + load * nodes;
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < nodes; ++n) w[n] = float(x[n]) * metres;
    }
}

} // namespace

PALPATE_IN_BOTH_PRECISIONS(dots)
PALPATE_IN_BOTH_PRECISIONS(stepDots)
PALPATE_IN_BOTH_PRECISIONS(beta)
PALPATE_IN_BOTH_PRECISIONS(step)
PALPATE_IN_BOTH_PRECISIONS(direction)
PALPATE_IN_BOTH_PRECISIONS(update)
PALPATE_IN_BOTH_PRECISIONS(result)

} // namespace palp::PALPATE_ISA
