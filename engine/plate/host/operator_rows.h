#pragma once
#include "engine/plate/host/frame.h"

// The operator row by row. Bending and twisting moments are computed once per node and cell, in rows that follow each
// other, where an invocation of a shader computes those around its node anew: the same numbers, with a third of the
// work.

namespace palp::PALPATE_ISA {

// Rules of the sides depend on how near a side is. A column far from both is like the middle one of eight cells, which
// is a constant: so loops along a row have no branch.
inline constexpr int kMiddle = 4, kMiddleCells = 8;

inline PlateLevel middleOfZ(PlateLevel g)
{
    g.cellsZ = kMiddleCells;
    return g;
}

/// The shared headers for one precision; what they ask of fields is not used here.
template <class Real>
struct Rules {
    using real = Real;

    [[noreturn]] static real rigidity(int, int) { __builtin_unreachable(); }
    [[noreturn]] static real deflection(int, int) { __builtin_unreachable(); }
    [[noreturn]] static real otherColour(int, int) { __builtin_unreachable(); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
};

/// Rows of A w, from the first to the last. Call next() once per row.
///
/// \tparam Field  gives row i of the deflection as `const Real* row(int i)`, valid while rows up to i + 2 are asked for
template <class Real, class Field>
class OperatorRows {
public:
    OperatorRows(const PlateLevel& level, const float* rigidity, Field& field)
        : g(level), middle(middleOfZ(level)), D_(rigidity), field_(field), nodes_(level.cellsZ + 1)
    {
        static thread_local Scratch<Real> scratch;
        const std::ptrdiff_t              stride = nodes_ + 2; // one more at either end, where no moment acts
        Real*                             at     = scratch.of(9 * stride);
        for (std::ptrdiff_t n = 0; n < 9 * stride; ++n) at[n] = 0;
        for (int n = 0; n < 3; ++n) {
            mx_[n] = at + (2 * n) * stride + 1;
            mz_[n] = at + (2 * n + 1) * stride + 1;
        }
        for (int n = 0; n < 2; ++n) t_[n] = at + (6 + n) * stride + 1;
        none_ = at + 8 * stride + 1;
        moments(0);
    }

    /// Writes row i of A w, i = 0, 1, ... in turn.
    void next(int i, Real* forces)
    {
        if (i < g.cellsX) {
            moments(i + 1);
            twists(i);
        }
        const Real* mw   = i > 0 ? mx_[(i + 2) % 3] : none_;
        const Real* mx   = mx_[i % 3];
        const Real* me   = i < g.cellsX ? mx_[(i + 1) % 3] : none_;
        const Real* mz   = mz_[i % 3];
        const Real* tw   = i > 0 ? t_[(i + 1) % 2] : none_;
        const Real* te   = i < g.cellsX ? t_[i % 2] : none_;
        const Real* w    = field_.row(i);
        const Real  bed  = Real(g.bed) * rules.nodeShare(middle, i, kMiddle);
        const Real  side = Real(g.bed) * rules.nodeShare(g, i, 0);
        const int   last = nodes_ - 1;
#pragma GCC ivdep
        for (int j = 0; j <= last; ++j)
            forces[j] = rules.forceFrom(mw[j], mx[j], me[j], mz[j - 1], mz[j], mz[j + 1], tw[j - 1], te[j - 1], tw[j],
                                        te[j], bed, w[j]);
        for (int j : {0, last})
            forces[j] = rules.forceFrom(mw[j], mx[j], me[j], mz[j - 1], mz[j], mz[j + 1], tw[j - 1], te[j - 1], tw[j],
                                        te[j], side, w[j]);
    }

private:
    void moments(int i)
    {
        const PlateLevel level  = g; // a copy that no store can change
        const Real*      before = field_.row(rules.mirrored(i - 1, level.cellsX));
        const Real*      w      = field_.row(i);
        const Real*      after  = field_.row(rules.mirrored(i + 1, level.cellsX));
        const float*     D      = D_ + std::ptrdiff_t(i) * nodes_;
        Real*            mx     = mx_[i % 3];
        Real*            mz     = mz_[i % 3];
        const int        last   = nodes_ - 1;
        if (rules.isHingedX(level, i))
#pragma GCC ivdep
            for (int j = 1; j < last; ++j) {
                const Real q = rules.secondDifference(w[j - 1], w[j], w[j + 1]);
                mx[j]        = 0;
                mz[j]        = Real(D[j]) * rules.bendingZ(level, true, 0, q);
            }
        else
#pragma GCC ivdep
            for (int j = 1; j < last; ++j) {
                const Real p = rules.secondDifference(before[j], w[j], after[j]);
                const Real q = rules.secondDifference(w[j - 1], w[j], w[j + 1]);
                mx[j]        = Real(D[j]) * rules.bendingX(level, false, p, q);
                mz[j]        = Real(D[j]) * rules.bendingZ(level, false, p, q);
            }
        for (int j : {0, last}) {
            const Real p = rules.secondDifference(before[j], w[j], after[j]);
            const Real q = rules.secondDifference(w[rules.mirrored(j - 1, last)], w[j], w[rules.mirrored(j + 1, last)]);
            mx[j]        = rules.momentX(level, i, j, Real(D[j]), p, q);
            mz[j]        = rules.momentZ(level, i, j, Real(D[j]), p, q);
        }
    }

    void twists(int i)
    {
        const PlateLevel level = middle;
        const Real*      w     = field_.row(i);
        const Real*      after = field_.row(i + 1);
        const float *    D = D_ + std::ptrdiff_t(i) * nodes_, *E = D + nodes_;
        Real*            t    = t_[i % 2];
        const int        last = nodes_ - 1;
#pragma GCC ivdep
        for (int j = 0; j < last; ++j)
            t[j] = rules.twistingMoment(level, 0, 0, (Real(D[j]) + Real(E[j])) + (Real(D[j + 1]) + Real(E[j + 1])),
                                        w[j], after[j], w[j + 1], after[j + 1]);
    }

    static inline Rules<Real> rules{};

    const PlateLevel g, middle;
    const float*     D_;
    Field&           field_;
    int              nodes_;
    Real *           mx_[3], *mz_[3], *t_[2], *none_;
};

/// A field as it lies in memory.
template <class Real>
struct PlainField {
    const Real* first;
    int         stride;

    const Real* row(int i) const { return first + std::ptrdiff_t(i) * stride; }
};

} // namespace palp::PALPATE_ISA
