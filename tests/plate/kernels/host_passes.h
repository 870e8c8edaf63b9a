#pragma once
#include <cstddef>
#include <vector>

#include "compute_shaders/shared/coarse_band.h"
#include "compute_shaders/shared/plate_push.h"
#include "tests/plate/kernels/plate_fields.h"
#include "tests/shaders/host_kernels.h"

/// The plate's kernels as C++: what each writes, given what it reads. Several loads lie one after the other.
namespace palp::host {

template <class Real>
Operator<Real> operatorOf(const PlateLevel& g, const std::vector<float>& rigidity, const Real* same, const Real* other)
{
    return {rigidity.data(), same, other, g.cellsZ + 1, g.shapeAt};
}

/// Calls visit(i, j, index in the field, index of the node) for every node of every load.
template <class Visit>
void forEachNode(const PlateLevel& g, std::size_t loads, Visit&& visit)
{
    std::size_t n = 0;
    for (std::size_t load = 0; load < loads; ++load)
        for (int i = 0; i <= g.cellsX; ++i)
            for (int j = 0; j <= g.cellsZ; ++j, ++n) visit(i, j, n, n - load * nodesOf(g));
}

template <class Real>
std::vector<Real> applied(const PlateLevel& g, const std::vector<float>& rigidity, const std::vector<Real>& w)
{
    std::vector<Real> forces(w.size());
    forEachNode(g, w.size() / nodesOf(g), [&](int i, int j, std::size_t n, std::size_t node) {
        const Real* of = w.data() + (n - node);
        auto        A  = operatorOf(g, rigidity, of, of);
        forces[n]      = A.isHeld(g, i, j) ? Real(0) : A.operatorAt(g, i, j);
    });
    return forces;
}

template <class Real>
std::vector<Real> residual(const PlateLevel& g, const std::vector<float>& rigidity, const std::vector<float>& force,
                           const std::vector<Real>& w)
{
    std::vector<Real> left = applied(g, rigidity, w);
    forEachNode(g, w.size() / nodesOf(g), [&](int i, int j, std::size_t n, std::size_t) {
        left[n] = holds(g, i, j) ? Real(0) : Real(force[n]) - left[n];
    });
    return left;
}

inline std::vector<float> inverseDivisor(const PlateLevel& g, const std::vector<float>& rigidity)
{
    std::vector<float> inverse(nodesOf(g));
    Row                row{rigidity.data(), g.cellsZ + 1, g.shapeAt};
    forEachNode(g, 1, [&](int i, int j, std::size_t n, std::size_t) {
        inverse[n] = row.isHeld(g, i, j) ? 0.0F : 1.0F / row.divisorAt(g, i, j);
    });
    return inverse;
}

/// What a half sweep reads and writes.
struct HalfSweep {
    std::vector<float> inverseDivisor, force, same, other, after;
};

/// \return `after` with the nodes of the colour relaxed
inline std::vector<float> relaxed(const RoughLevel& level, const HalfSweep& fields, unsigned colour)
{
    const PlateLevel&  g     = level.g;
    std::vector<float> after = fields.after;
    forEachNode(g, after.size() / nodesOf(g), [&](int i, int j, std::size_t n, std::size_t node) {
        if ((unsigned(i + j) & 1U) != colour) return;
        const std::size_t first = n - node;
        auto              A = operatorOf(g, level.rigidity, fields.same.data() + first, fields.other.data() + first);
        after[n] = A.relaxed(fields.same[n], fields.force[n], A.operatorAt(g, i, j), fields.inverseDivisor[node]);
    });
    return after;
}

/// What a step of Chebyshev's iteration reads and writes.
struct SmoothStep {
    std::vector<float> inverseDivisor, force, before, after;
    float              ahead, step;
};

inline std::vector<float> smoothed(const RoughLevel& level, const SmoothStep& fields)
{
    const PlateLevel&  g     = level.g;
    std::vector<float> after = fields.after;
    forEachNode(g, after.size() / nodesOf(g), [&](int i, int j, std::size_t n, std::size_t node) {
        const float* of = fields.before.data() + (n - node);
        auto         A  = operatorOf(g, level.rigidity, of, of);
        const float  w  = fields.before[n];
        after[n]        = A.smoothed(w, fields.ahead == 0 ? w : fields.after[n], fields.force[n], A.operatorAt(g, i, j),
                                     fields.inverseDivisor[node], fields.ahead, fields.step);
    });
    return after;
}

template <class Real>
std::vector<Real> interpolated(const LevelPair& pair, const std::vector<Real>& coarse)
{
    const std::size_t loads = coarse.size() / nodesOf(pair.coarse);
    std::vector<Real> fine(loads * nodesOf(pair.fine));
    forEachNode(pair.fine, loads, [&](int i, int j, std::size_t n, std::size_t) {
        const Real* of = coarse.data() + n / nodesOf(pair.fine) * nodesOf(pair.coarse);
        fine[n] = Prolong<Real>{pair.tableX.data(), pair.tableZ.data(), of, pair.coarse.cellsZ + 1}.prolongedAt(i, j);
    });
    return fine;
}

inline std::vector<float> restricted(const LevelPair& pair, const std::vector<float>& fine)
{
    const std::size_t  loads = fine.size() / nodesOf(pair.fine);
    std::vector<float> coarse(loads * nodesOf(pair.coarse));
    forEachNode(pair.coarse, loads, [&](int i, int j, std::size_t n, std::size_t) {
        const float* of = fine.data() + n / nodesOf(pair.coarse) * nodesOf(pair.fine);
        Restrict     gather{pair.tableX.data(), pair.tableZ.data(), of, pair.fine.cellsZ + 1};
        coarse[n] = gather.restrictedAt(i, j, pair.fine.cellsX + 1, pair.fine.cellsZ + 1);
    });
    return coarse;
}

inline std::vector<float> coarsened(const LevelPair& pair, const std::vector<float>& rigidity)
{
    const std::size_t  nodes = nodesOf(pair.coarse);
    std::vector<float> coarse((pair.coarse.shapeAt == 0 ? 1 : 2) * nodes);
    Coarsen            mean{rigidity.data(), pair.fine.cellsZ + 1, pair.fine.shapeAt};
    forEachNode(pair.coarse, 1, [&](int i, int j, std::size_t n, std::size_t) {
        coarse[n] = mean.coarseRigidityAt(pair.fine, pair.coarse, i, j);
        if (pair.coarse.shapeAt != 0) coarse[nodes + n] = mean.coarseShapeAt(pair.fine, pair.coarse, i, j);
    });
    return coarse;
}

// --- the coarsest level; \return columns of halfBand + 1 numbers, see coarse_band.h

template <class Real>
std::vector<Real> assembled(const PlateLevel& g, const std::vector<float>& rigidity)
{
    const int         unknowns = int(nodesOf(g)), slots = halfBand(g) + 1;
    std::vector<Real> band(std::size_t(unknowns) * std::size_t(slots));
    RowOf<Real>       row{rigidity.data(), g.cellsZ + 1, g.shapeAt};
    for (int column = 0; column < unknowns; ++column)
        for (int offset = 0; offset < slots; ++offset) {
            Real&     entry = band[std::size_t(column * slots + offset)];
            const int n     = column + offset;
            const int i = columnOf(g, n), j = rowOf(g, n);
            row.unitI = columnOf(g, column);
            row.unitJ = rowOf(g, column);
            entry     = offset == 0 ? Real(1) : Real(0);
            if (n < unknowns && !row.isHeld(g, i, j) && !row.isHeld(g, row.unitI, row.unitJ)) {
                const bool near = abs(i - row.unitI) + abs(j - row.unitJ) <= 2;
                entry           = near ? row.operatorAt(g, i, j) : Real(0);
            }
        }
    return band;
}

/// Below this share of the diagonal a pivot is lost.
template <class Real>
Real leastPivot()
{
    return Real(sizeof(Real) == sizeof(double) ? kLeastPivotDouble : kLeastPivot);
}

template <class Real>
std::vector<Real> factored(const PlateLevel& g, const std::vector<Real>& matrix)
{
    const std::size_t unknowns = nodesOf(g), slots = std::size_t(halfBand(g) + 1);
    std::vector<Real> band = matrix, factor(band.size());
    for (std::size_t n = 0; n < unknowns; ++n) {
        const Real  pivot   = band[n * slots];
        const Real  inverse = pivot > leastPivot<Real>() * matrix[n * slots] ? shared::inverseRoot(pivot) : Real(0);
        Real* const column  = factor.data() + n * slots;
        for (std::size_t d = 0; d < slots; ++d) column[d] = band[n * slots + d] * inverse;
        for (std::size_t d = 1; d < slots && n + d < unknowns; ++d)
            for (std::size_t e = d; e < slots; ++e) band[(n + d) * slots + e - d] -= column[d] * column[e];
        column[0] = inverse;
    }
    return factor;
}

template <class Real>
std::vector<float> coarseSolved(const PlateLevel& g, const std::vector<Real>& factor, const std::vector<float>& force)
{
    const std::size_t  unknowns = nodesOf(g), slots = std::size_t(halfBand(g) + 1);
    std::vector<float> w(force.size());
    std::vector<Real>  right(unknowns);
    const auto         nodeOf = [&](std::size_t n) {
        return std::size_t(columnOf(g, int(n)) * (g.cellsZ + 1) + rowOf(g, int(n)));
    };
    for (std::size_t first = 0; first < force.size(); first += unknowns) {
        for (std::size_t n = 0; n < unknowns; ++n)
            right[n] = holds(g, columnOf(g, int(n)), rowOf(g, int(n))) ? Real(0) : Real(force[first + nodeOf(n)]);
        for (std::size_t n = 0; n < unknowns; ++n) {
            right[n] *= factor[n * slots];
            for (std::size_t d = 1; d < slots && n + d < unknowns; ++d)
                right[n + d] -= factor[n * slots + d] * right[n];
        }
        for (std::size_t n = unknowns; n-- > 0;) {
            right[n] *= factor[n * slots];
            for (std::size_t d = 1; d < slots && d <= n; ++d) right[n - d] -= factor[(n - d) * slots + d] * right[n];
        }
        for (std::size_t n = 0; n < unknowns; ++n) w[first + nodeOf(n)] = float(right[n]);
    }
    return w;
}

// --- conjugate gradients

/// Sums of terms t, t + partials, ... of a dot product, and the sum of their magnitudes.
template <class Real>
struct Partial {
    Real   sum  = 0;
    double size = 0;
};

template <class Real, class Term>
std::vector<Partial<Real>> partialSums(std::size_t terms, std::size_t partials, const Term& term)
{
    std::vector<Partial<Real>> sums(partials);
    for (std::size_t n = 0; n < terms; ++n) {
        sums[n % partials].sum += term(n);
        sums[n % partials].size += std::abs(double(term(n)));
    }
    return sums;
}

/// The partial sums completed by a workgroup of `width` invocations, a power of two.
template <class Real>
Real total(const Real* partials, std::size_t count, std::size_t width)
{
    std::vector<Real> sums(width);
    for (std::size_t n = 0; n < count; ++n) sums[n % width] += partials[n];
    for (std::size_t step = width / 2; step > 0; step /= 2)
        for (std::size_t t = 0; t < step; ++t) sums[t] += sums[t + step];
    return sums[0];
}

template <class Real>
void beta(const ScalarsPush& push, const std::vector<Real>& partials, std::size_t width, std::vector<Real>& state)
{
    for (std::size_t load = 0; load < push.loads; ++load) {
        Real* const at   = state.data() + load * kStateWords;
        const Real  rz   = total(partials.data() + 2 * load * push.partials, push.partials, width);
        const bool  anew = push.begins == 2;
        at[kStateBeta]   = anew || at[kStateRz] == 0 ? Real(0) : rz / at[kStateRz];
        at[kStateRz]     = rz;
        at[kStateEnergy] = total(partials.data() + (2 * load + 1) * push.partials, push.partials, width);
        if (push.begins != 0) at[kStateSteps] = 0;
        if (anew) at[kStateGain] = at[kStateRatio] = 0;
    }
}

/// \return whether every load is finished
template <class Real>
bool step(const ScalarsPush& push, const std::vector<Real>& partials, std::size_t width, std::vector<Real>& state)
{
    bool finished = true;
    for (std::size_t load = 0; load < push.loads; ++load) {
        Real* const at     = state.data() + load * kStateWords;
        const Real  pq     = total(partials.data() + load * push.partials, push.partials, width);
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
        finished           = finished && push.tolerance != 0 && !(now.estimate > Real(push.tolerance));
    }
    return finished;
}

} // namespace palp::host
