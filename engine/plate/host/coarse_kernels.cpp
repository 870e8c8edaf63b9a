#include "engine/plate/host/together.h"

// The coarsest level: coarse_factor.comp and coarse_solve.comp.
//
// The shaders update all unknowns within reach of the one that they have just solved. Here an unknown is updated by all
// those before it, which loads its numbers once: they stay in registers. The same terms are subtracted from every
// number in the same order, so its bits are the same.

namespace palp::PALPATE_ISA {
namespace {

template <class Real>
struct Sides {
    using real = Real;

#include "compute_shaders/shared/plate_grid.h"
};

// The size of a register [bytes]. Compilers make slow code of longer vectors, and columns of at most 35 entries gain
// nothing from registers of 64.
#if defined(__AVX__)
constexpr int kRegister = 32;
#else
constexpr int kRegister = 16;
#endif

/// A register full of numbers.
template <class Real>
struct Lanes {
    static constexpr int kLanes = kRegister / int(sizeof(Real));
    typedef Real         Vector __attribute__((vector_size(kRegister)));

    static Vector load(const Real* from)
    {
        Vector v;
        __builtin_memcpy(&v, from, sizeof v);
        return v;
    }
    static void store(Real* to, Vector v) { __builtin_memcpy(to, &v, sizeof v); }

    /// Keeps the lanes up to one, and sets the others to 0.
    static Vector upTo(int last, Vector v)
    {
        Vector number;
        for (int t = 0; t < kLanes; ++t) number[t] = Real(t);
        return number <= Real(last) ? v : Vector{};
    }
};

/// Columns of L while they are computed, in vectors followed by zeros.
template <class Real>
struct Columns : Lanes<Real> {
    using typename Lanes<Real>::Vector;
    using Lanes<Real>::kLanes;
    using Lanes<Real>::load;
    static constexpr int kVectors = (kMostHalfBand + kLanes) / kLanes;
    static constexpr int kStride  = (kVectors + 1) * kLanes + kMostHalfBand; ///< readable from any of its entries on

    /// Subtracts from column n the contributions of up to `reach` columns before it; `column` is L's.
    ///
    /// The one that is a columns before reaches the first reach + 1 - a entries: those in at most kCount vectors first.
    template <int kCount>
    static void subtract(Vector* sums, const Real* column, int reach, int before)
    {
        const int first = min(before, reach - (kCount - 1) * kLanes), last = max(1, reach - kCount * kLanes + 1);
        for (int a = first; a >= last; --a) {
            const Real* other = column - std::ptrdiff_t(a) * kStride + a;
            for (int v = 0; v < kCount; ++v) sums[v] -= other[0] * load(other + v * kLanes);
        }
        if constexpr (kCount < kVectors) subtract<kCount + 1>(sums, column, reach, before);
    }
};

template <class Real>
void factorOf(const HostDispatch& d)
{
    using C = Columns<Real>;
    static thread_local Scratch<Real> scratch;
    const PlateLevel&                 g      = pushed<LevelPush>(d).level;
    const auto*                       band   = bound<const Real>(d, 0);
    auto*                             result = bound<Real>(d, 1);
    const int                         reach = halfBand(g), slots = reach + 1;
    const int                         unknowns = int(nodesOf(g));

    const bool  isDouble = sizeof(Real) == sizeof(double);
    const Real  least    = Real(isDouble ? kLeastPivotDouble : kLeastPivot);
    const Real  doubtful = Real(isDouble ? kLeastPivotDouble : kDoubtfulPivot);
    uint        lost     = 0;
    Real* const L        = scratch.of(std::ptrdiff_t(kMostCoarseNodes) * C::kStride);
    for (int n = 0; n < unknowns; ++n) {
        const Real* entries = band + n * slots;
        Real*       column  = L + std::ptrdiff_t(n) * C::kStride;
        for (int e = 0; e < C::kVectors * C::kLanes; ++e) column[e] = e <= reach ? entries[e] : Real(0);
        typename C::Vector sums[C::kVectors];
        for (int v = 0; v < C::kVectors; ++v) sums[v] = C::load(column + v * C::kLanes);
        C::template subtract<1>(sums, column, reach, min(n, reach));
        const Real pivot   = sums[0][0];
        const Real inverse = pivot > least * entries[0] ? inverseRoot(pivot) : Real(0);
        if (!(pivot > doubtful * entries[0])) ++lost;
        for (int v = 0; v < C::kVectors; ++v) C::store(column + v * C::kLanes, sums[v] * inverse);
        for (int e = 0; e <= reach; ++e) result[n * slots + e] = column[e];
        result[n * slots] = inverse;
    }
    *bound<uint>(d, 2) = lost;
}

/// Solves for the unknowns n to n + kLanes - 1 of L y = f, given those before them; reach must be at least kLanes.
template <class Real>
void forwardTogether(const Real* factor, int reach, int n, Real* y)
{
    using C         = Lanes<Real>;
    const int slots = reach + 1;
    auto      sums  = C::load(y + n);
    // The farthest columns reach only the first lanes; beyond their end lies the next column.
    for (int last = max(0, reach - n); last < C::kLanes - 1; ++last) {
        const int k = n - reach + last;
        sums -= C::upTo(last, C::load(factor + k * slots + reach - last)) * y[k];
    }
    for (int k = max(0, n - reach + C::kLanes - 1); k < n; ++k) sums -= C::load(factor + k * slots + n - k) * y[k];
#pragma GCC unroll 16
    for (int t = 0; t < C::kLanes; ++t) {
        const Real* column = factor + (n + t) * slots;
        y[n + t]           = sums[t] * column[0];
        sums -= C::load(column - t) * y[n + t]; // lanes up to t are done
    }
}

template <class Real>
void forward(const Real* factor, int reach, int unknowns, Real* y)
{
    constexpr int kLanes = Lanes<Real>::kLanes;
    const int     slots  = reach + 1;
    int           n      = 0;
    for (; reach >= kLanes && n + kLanes <= unknowns; n += kLanes) forwardTogether(factor, reach, n, y);
    for (; n < unknowns; ++n) {
        for (int k = max(0, n - reach); k < n; ++k) y[n] -= factor[k * slots + n - k] * y[k];
        y[n] *= factor[n * slots];
    }
}

/// The same for several loads: four unknowns at a time, because one alone would wait for each of its sums.
template <class Real>
void forward(const Real* factor, int reach, int unknowns, Together<Real>* y)
{
    constexpr int kAtOnce = 4;
    const int     slots   = reach + 1;
    int           n       = 0;
    for (; reach >= kAtOnce && n + kAtOnce <= unknowns; n += kAtOnce) {
        Together<Real> sums[kAtOnce];
        for (int t = 0; t < kAtOnce; ++t) sums[t] = y[n + t];
        // The farthest columns reach only the first unknowns.
        const int all = max(0, n + kAtOnce - 1 - reach);
        for (int k = max(0, n - reach); k < all; ++k)
            for (int t = 0; n + t - k <= reach; ++t) sums[t] -= factor[k * slots + n + t - k] * y[k];
        for (int k = all; k < n; ++k)
            for (int t = 0; t < kAtOnce; ++t) sums[t] -= factor[k * slots + n + t - k] * y[k];
        for (int t = 0; t < kAtOnce; ++t) {
            const Real* column = factor + (n + t) * slots;
            y[n + t]           = column[0] * sums[t];
            for (int u = t + 1; u < kAtOnce; ++u) sums[u] -= column[u - t] * y[n + t];
        }
    }
    for (; n < unknowns; ++n) {
        for (int k = max(0, n - reach); k < n; ++k) y[n] -= factor[k * slots + n - k] * y[k];
        y[n] *= factor[n * slots];
    }
}

/// Solves L' w = y, from the last unknown on.
/// \param w  y, then the result; followed by zeros
template <class Real>
void backward(const NumberOf<Real>* factor, int reach, int unknowns, Real* w)
{
    // Several unknowns side by side, as long as they are independent: one alone would wait for each of its sums.
    constexpr int kTogether = sizeof(Real) > sizeof(double) ? 4 : 8;
    const int     slots     = reach + 1;
    int           n         = unknowns;
    for (; reach >= kTogether && n >= kTogether; n -= kTogether) {
        Real*       here   = w + n - kTogether;
        const auto* column = factor + (n - kTogether) * slots;
        Real        sums[kTogether];
        for (int t = 0; t < kTogether; ++t) sums[t] = here[t];
        for (int e = reach; e >= kTogether; --e)
            for (int t = 0; t < kTogether; ++t) sums[t] -= column[t * slots + e] * here[t + e];
#pragma GCC unroll 8
        for (int t = kTogether - 1; t >= 0; --t) {
#pragma GCC unroll 8
            for (int e = kTogether - 1; e >= 1; --e) sums[t] -= column[t * slots + e] * here[t + e];
            here[t] = column[t * slots] * sums[t];
        }
    }
    for (n = n - 1; n >= 0; --n) {
        for (int e = reach; e >= 1; --e) w[n] -= factor[n * slots + e] * w[n + e];
        w[n] *= factor[n * slots];
    }
}

template <class Real>
void coarseSolveOf(const HostDispatch& d)
{
    using Single               = AsMany<float, Real>;
    const PlateLevel& g        = pushed<LevelPush>(d).level;
    const auto*       factor   = bound<const NumberOf<Real>>(d, 0);
    const int         unknowns = int(nodesOf(g)), nodes = g.cellsZ + 1;
    const int         perI = zIsShorter(g) ? nodes : 1, perJ = zIsShorter(g) ? 1 : g.cellsX + 1;
    Sides<float>      sides;

    Real right[kMostCoarseNodes + kMostHalfBand] = {};
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        const Single* force = bound<const Single>(d, 1) + load * unknowns;
        Single*       w     = bound<Single>(d, 2) + load * unknowns;
        for (int i = 0; i <= g.cellsX; ++i)
            for (int j = 0; j < nodes; ++j)
                right[i * perI + j * perJ] = sides.isHeld(g, i, j) ? Real(0) : Real(force[i * nodes + j]);
        forward(factor, halfBand(g), unknowns, right);
        backward(factor, halfBand(g), unknowns, right);
        for (int i = 0; i <= g.cellsX; ++i)
            for (int j = 0; j < nodes; ++j) w[i * nodes + j] = Single(right[i * perI + j * perJ]);
    }
}

} // namespace

PALPATE_IN_BOTH_PRECISIONS(factor)
PALPATE_REALS_ALONE_AND_TOGETHER(coarseSolve)

} // namespace palp::PALPATE_ISA
