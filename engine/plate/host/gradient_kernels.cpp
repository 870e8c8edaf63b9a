#include "engine/plate/host/together.h"

// Conjugate gradients: cg_dot.comp, cg_scalars.comp, cg_direction.comp, cg_update.comp,
// plate_result.comp and plate_footprints.comp.

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
    for (std::ptrdiff_t t = 0; t < partials; ++t) sums[t] = Real(0);
    for (std::ptrdiff_t first = 0; first < nodes; first += partials) {
        const std::ptrdiff_t count = nodes - first < partials ? nodes - first : partials;
#pragma GCC ivdep
        for (std::ptrdiff_t t = 0; t < count; ++t) sums[t] += term(first + t);
    }
}

/// Computes the partial sums of the loads that lie in one field; those of each load follow one another.
/// \param apart  from the first partial sum of a load to that of the next
template <class At, class Term>
void addTermsOf(std::ptrdiff_t nodes, std::ptrdiff_t partials, NumberOf<At>* sums, std::ptrdiff_t apart,
                const Term& term)
{
    if constexpr (NodeOf<At>::kLoads == 1) {
        addTerms(nodes, partials, sums, term);
    } else {
        static thread_local Scratch<At> scratch;
        At* const                       together = scratch.of(partials);
        addTerms(nodes, partials, together, term);
        for (int load = 0; load < NodeOf<At>::kLoads; ++load)
            for (std::ptrdiff_t t = 0; t < partials; ++t) sums[load * apart + t] = together[t][load];
    }
}

/// Returns a scalar of the loads in a field.
template <class At>
At scalarOf(const NumberOf<At>* state, std::ptrdiff_t field, int word)
{
    if constexpr (NodeOf<At>::kLoads == 1) {
        return state[field * kStateWords + word];
    } else {
        At all;
        for (int load = 0; load < NodeOf<At>::kLoads; ++load)
            all[load] = state[(field * NodeOf<At>::kLoads + load) * kStateWords + word];
        return all;
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
    using Single     = AsMany<float, Real>;
    const auto& push = pushed<VectorPush>(d);
    for (std::ptrdiff_t field = 0; field < fieldsOf<Real>(d); ++field) {
        const std::ptrdiff_t base = field * push.nodes, apart = 2 * std::ptrdiff_t(push.partials);
        const auto*          r    = bound<const Real>(d, 0) + base;
        const auto*          z    = bound<const Single>(d, 1) + base;
        const auto*          x    = bound<const Real>(d, 2) + base;
        const auto*          f    = bound<const Single>(d, 3) + base;
        auto* const          sums = bound<NumberOf<Real>>(d, 4) + field * NodeOf<Real>::kLoads * apart;
        addTermsOf<Real>(push.nodes, push.partials, sums, apart, [=](std::ptrdiff_t n) { return r[n] * Real(z[n]); });
        addTermsOf<Real>(push.nodes, push.partials, sums + push.partials, apart,
                         [=](std::ptrdiff_t n) { return Real(f[n]) * x[n]; });
    }
}

template <class Real>
void stepDotsOf(const HostDispatch& d)
{
    const auto&          push  = pushed<VectorPush>(d);
    const std::ptrdiff_t apart = push.partials;
    for (std::ptrdiff_t field = 0; field < fieldsOf<Real>(d); ++field) {
        const auto* p    = bound<const Real>(d, 0) + field * push.nodes;
        const auto* q    = bound<const Real>(d, 1) + field * push.nodes;
        auto* const sums = bound<NumberOf<Real>>(d, 2) + field * NodeOf<Real>::kLoads * apart;
        addTermsOf<Real>(push.nodes, apart, sums, apart, [=](std::ptrdiff_t n) { return p[n] * q[n]; });
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
        const auto  now    = Scalars<Real>{}.stepOf(pq, at[kStateRz], at[kStateBeta], at[kStateEnergy], at[kStateAlpha],
                                                    at[kStateGain], at[kStateRatio], at[kStateSteps],
                                                    {at[kStateSlowest], at[kStateLast], at[kStateAlong]});
        at[kStateAlpha]    = now.alpha;
        at[kStateGain]     = now.gain;
        at[kStateRatio]    = now.ratio;
        at[kStateEstimate] = now.estimate;
        at[kStateSteps]    = now.steps;
        at[kStateSlowest]  = now.slowest.most;
        at[kStateLast]     = now.slowest.last;
        at[kStateAlong]    = now.slowest.along;
        unfinished         = unfinished || push.tolerance == 0 || now.estimate > Real(push.tolerance);
    }
    if (unfinished) return;
    for (uint n = 0; n < push.argumentWords; ++n) arguments[n] = 0;
}

template <class Real>
bool isZero(const Real& number)
{
    return number == 0;
}

template <class Real>
bool isZero(const Together<Real>& numbers)
{
    bool all = true;
    for (int load = 0; load < kLoadsTogether; ++load) all = all && numbers[load] == 0;
    return all;
}

template <class Real>
void directionOf(const HostDispatch& d)
{
    const auto&          push  = pushed<VectorPush>(d);
    const auto*          state = bound<const NumberOf<Real>>(d, 0);
    const std::ptrdiff_t nodes = push.nodes;
    for (std::ptrdiff_t field = 0; field < fieldsOf<Real>(d); ++field) {
        const Real  beta = scalarOf<Real>(state, field, kStateBeta);
        const auto* z    = bound<const AsMany<float, Real>>(d, 1) + field * nodes;
        auto*       p    = bound<Real>(d, 2) + field * nodes;
        if (isZero(beta)) // p may hold anything before the first step
            for (std::ptrdiff_t n = 0; n < nodes; ++n) p[n] = Real(z[n]);
        else
#pragma GCC ivdep
            for (std::ptrdiff_t n = 0; n < nodes; ++n) p[n] = Real(z[n]) + beta * p[n];
    }
}

template <class Real>
void updateOf(const HostDispatch& d)
{
    const auto& push           = pushed<VectorPush>(d);
    using Single               = AsMany<float, Real>;
    const auto*          state = bound<const NumberOf<Real>>(d, 0);
    const std::ptrdiff_t nodes = push.nodes;
    for (std::ptrdiff_t field = 0; field < fieldsOf<Real>(d); ++field) {
        // All loads of a dispatch have taken as many steps.
        const auto taken = state[field * NodeOf<Real>::kLoads * kStateWords + kStateSteps];
        if (taken != NumberOf<Real>(float(push.iteration))) continue;
        const Real  alpha   = scalarOf<Real>(state, field, kStateAlpha);
        const auto* p       = bound<const Real>(d, 1) + field * nodes;
        const auto* q       = bound<const Real>(d, 2) + field * nodes;
        auto*       x       = bound<Real>(d, 3) + field * nodes;
        auto*       r       = bound<Real>(d, 4) + field * nodes;
        auto*       rounded = bound<Single>(d, 5) + field * nodes;
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < nodes; ++n) {
            x[n] += alpha * p[n];
            const Real left = r[n] - alpha * q[n];
            r[n]            = left;
            rounded[n]      = Single(left);
        }
    }
}

template <class Real>
void resultOf(const HostDispatch& d)
{
    using Single               = AsMany<float, Real>;
    const std::ptrdiff_t nodes = pushed<VectorPush>(d).nodes;
    for (std::ptrdiff_t field = 0; field < fieldsOf<Real>(d); ++field) {
        const auto*  x      = bound<const Real>(d, 0) + field * nodes;
        const Single metres = bound<const Single>(d, 1)[field];
        auto*        w      = bound<Single>(d, 2) + field * nodes;
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < nodes; ++n) w[n] = Single(x[n]) * metres;
    }
}

template <class At>
void footprintsOf(const HostDispatch& d)
{
    using Real = NumberOf<At>;
    static thread_local Scratch<At> scratch;
    const std::ptrdiff_t            nodes = pushed<VectorPush>(d).nodes, width = d.workgroup.x;
    const auto*                     words     = bound<const uint>(d, 2);
    auto*                           responses = bound<Real>(d, 3);
    At* const                       left      = scratch.of(width);
    for (std::ptrdiff_t field = 0; field < fieldsOf<At>(d); ++field) {
        const auto* r = bound<const At>(d, 0) + field * nodes;
        const auto* x = bound<const At>(d, 1) + field * nodes;
        addTerms(nodes, width, left, [=](std::ptrdiff_t n) { return r[n] * x[n]; });
        for (int lane = 0; lane < NodeOf<At>::kLoads; ++lane) {
            const std::ptrdiff_t load = field * NodeOf<At>::kLoads + lane;
            Real                 sums[kResponseWords][1024];
            for (std::ptrdiff_t t = 0; t < width; ++t) {
                sums[kResponseWork][t]    = numberOf(left[t], lane);
                sums[kResponseChangeX][t] = sums[kResponseChangeZ][t] = 0;
            }
            const uint* part  = words + words[load * kFootprintHead];
            const uint  count = words[load * kFootprintHead + 1];
            for (uint k = 0; k < count; ++k, part += kPartWords) {
                const Real w = numberOf(x[part[0]], lane);
                for (int n = 0; n < kResponseWords; ++n) {
                    float number;
                    __builtin_memcpy(&number, part + 1 + n, sizeof number);
                    sums[n][k % width] += Real(number) * w;
                }
            }
            for (int n = 0; n < kResponseWords; ++n)
                responses[load * kResponseWords + n] = total(sums[n], uint(width), uint(width));
        }
    }
}

} // namespace

PALPATE_IN_BOTH_PRECISIONS(beta)
PALPATE_IN_BOTH_PRECISIONS(step)
PALPATE_REALS_ALONE_AND_TOGETHER(dots)
PALPATE_REALS_ALONE_AND_TOGETHER(stepDots)
PALPATE_REALS_ALONE_AND_TOGETHER(direction)
PALPATE_REALS_ALONE_AND_TOGETHER(update)
PALPATE_REALS_ALONE_AND_TOGETHER(result)
PALPATE_REALS_ALONE_AND_TOGETHER(footprints)

} // namespace palp::PALPATE_ISA
