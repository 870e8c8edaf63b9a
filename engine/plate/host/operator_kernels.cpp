#include "engine/plate/host/operator_rows.h"

// plate_apply.comp, plate_residual.comp and plate_relax.comp.

namespace palp::PALPATE_ISA {
namespace {

/// Returns whether all nodes of a row but perhaps its ends are held.
bool isHeldRow(const PlateLevel& g, int i)
{
    return Rules<float>{}.isHeld(middleOfZ(g), i, kMiddle);
}

/// Passes each row of A w to rowTo(i); value(j, A w) is 0 for held nodes.
template <class Real, class Field, class ToRow>
void forEachRow(const PlateLevel& g, const float* D, Field& field, ToRow&& rowTo)
{
    OperatorRows<Real, Field> rows(g, D, field);
    const int                 last = g.cellsZ;
    for (int i = 0; i <= g.cellsX; ++i) {
        const auto to = rowTo(i);
        rows.next(i, to);
        if (isHeldRow(g, i))
            for (int j = 1; j < last; ++j) to.put(j, Real(0));
        for (int j : {0, last})
            if (Rules<Real>{}.isHeld(g, i, j)) to.put(j, Real(0));
    }
}

template <class Real>
void applyOf(const HostDispatch& d)
{
    const PlateLevel& g      = pushed<LevelPush>(d).level;
    const auto*       D      = bound<const float>(d, 0);
    const auto*       w      = bound<const Real>(d, 1);
    auto*             result = bound<Real>(d, 2);
    const int         nodes  = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        PlainField<Real> field{w + load * nodesOf(g), nodes};
        forEachRow<Real>(g, D, field, [&](int i) {
            Real* to = result + load * nodesOf(g) + std::ptrdiff_t(i) * nodes;
            return RowTo{[](int, const Real& force) { return force; },
                         [=](int j, const Real& force) { to[j] = force; }};
        });
    }
}

/// The residual of w; with kRounds also in floats.
template <class Real, bool kRounds>
void leftOf(const HostDispatch& d)
{
    using Single              = AsMany<float, Real>;
    const PlateLevel& g       = pushed<LevelPush>(d).level;
    const auto*       D       = bound<const float>(d, 0);
    const auto*       force   = bound<const Single>(d, 1);
    const auto*       w       = bound<const Real>(d, 2);
    auto*             result  = bound<Real>(d, 3);
    auto*             rounded = kRounds ? bound<Single>(d, 4) : nullptr;
    const int         nodes   = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        PlainField<Real> field{w + load * nodesOf(g), nodes};
        forEachRow<Real>(g, D, field, [&](int i) {
            const std::ptrdiff_t at   = load * nodesOf(g) + std::ptrdiff_t(i) * nodes;
            const Single*        f    = force + at;
            Real*                to   = result + at;
            Single*              also = rounded + at;
            return RowTo{[=](int j, const Real& a) { return Real(f[j]) - a; },
                         [=](int j, const Real& left) {
                             to[j] = left;
                             if (kRounds) also[j] = Single(left);
                         }};
        });
    }
}

/// Takes nodes of one colour from one field and the others from another, row by row.
template <class Real>
struct TwoColours {
    const Real* same;
    const Real* other;
    int         nodes;
    unsigned    colour;
    Real*       rows; ///< six of them
    int         made = 0;

    const Real* row(int i)
    {
        if (same == other) return same + std::ptrdiff_t(i) * nodes;
        for (; made <= i; ++made) {
            const Real* a   = same + std::ptrdiff_t(made) * nodes;
            const Real* b   = other + std::ptrdiff_t(made) * nodes;
            Real*       to  = rows + std::ptrdiff_t(made % 6) * nodes;
            const int   odd = int((unsigned(made) + colour) & 1U);
#pragma GCC ivdep
            for (int j = 0; j < nodes; ++j) to[j] = (j & 1) == odd ? a[j] : b[j];
        }
        return rows + std::ptrdiff_t(i % 6) * nodes;
    }
};

template <class Real>
void residualOf(const HostDispatch& d)
{
    leftOf<Real, false>(d);
}

template <class Real>
void startOf(const HostDispatch& d)
{
    leftOf<Real, true>(d);
}

template <class Real>
void relaxOf(const HostDispatch& d)
{
    const auto& [g, colour] = pushed<RelaxPush>(d);
    const auto* D           = bound<const float>(d, 0);
    const auto* inverse     = bound<const float>(d, 1);
    const auto* force       = bound<const Real>(d, 2);
    const auto* same        = bound<const Real>(d, 3);
    const auto* other       = bound<const Real>(d, 4);
    auto*       after       = bound<Real>(d, 5);
    const int   nodes       = g.cellsZ + 1;

    static thread_local Scratch<Real> scratch;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        const std::ptrdiff_t                 first = load * nodesOf(g);
        TwoColours<Real>                     field{same + first, other + first, nodes, colour,
                               scratch.of(6 * std::ptrdiff_t(nodes) + 1) + 1};
        OperatorRows<Real, TwoColours<Real>> rows(g, D, field);
        for (int i = 0; i <= g.cellsX; ++i) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float*         inv = inverse + at;
            const Real *         f = force + first + at, *w = field.row(i);
            Real*                to  = after + first + at;
            const int            odd = int((unsigned(i) + colour) & 1U);
            rows.next(i, RowTo{[=](int j, const Real& a) { // the inverse divisor of a held node is 0
                                   const Real relaxed = Rules<Real>{}.relaxed(w[j], f[j], a, Real(inv[j]));
                                   return (j & 1) == odd ? relaxed : to[j];
                               },
                               [=](int j, const Real& value) { to[j] = value; }});
        }
    }
}

template <class Real>
void relaxFirstOf(const HostDispatch& d)
{
    const auto& [g, colour] = pushed<RelaxPush>(d);
    const auto* inverse     = bound<const float>(d, 0);
    const auto* force       = bound<const Real>(d, 1);
    auto*       after       = bound<Real>(d, 2);
    const int   nodes       = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load)
        for (int i = 0; i <= g.cellsX; ++i) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float*         inv = inverse + at;
            const Real*          f   = force + load * nodesOf(g) + at;
            Real*                to  = after + load * nodesOf(g) + at;
            const int            odd = int((unsigned(i) + colour) & 1U);
#pragma GCC ivdep
            for (int j = 0; j < nodes; ++j) to[j] = (j & 1) == odd ? f[j] * Real(inv[j]) : to[j];
        }
}

template <class Real>
void smoothOf(const HostDispatch& d)
{
    const auto& [g, ahead, step] = pushed<SmoothPush>(d);
    const auto* D                = bound<const float>(d, 0);
    const auto* inverse          = bound<const float>(d, 1);
    const auto* force            = bound<const Real>(d, 2);
    const auto* before           = bound<const Real>(d, 3);
    auto*       after            = bound<Real>(d, 4);
    const int   nodes            = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        const std::ptrdiff_t                 first = load * nodesOf(g);
        PlainField<Real>                     field{before + first, nodes};
        OperatorRows<Real, PlainField<Real>> rows(g, D, field);
        for (int i = 0; i <= g.cellsX; ++i) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float*         inv = inverse + at;
            const Real *         f = force + first + at, *w = field.row(i);
            Real*                to  = after + first + at;
            const auto           put = [=](int j, const Real& value) { to[j] = value; };
            if (ahead == 0)
                rows.next(i, RowTo{[=, by = step](int j, const Real& a) {
                                       return Rules<Real>{}.smoothed(w[j], w[j], f[j], a, Real(inv[j]), Real(0.0f),
                                                                     Real(by));
                                   },
                                   put});
            else
                rows.next(i, RowTo{[=, more = ahead, by = step](int j, const Real& a) {
                                       return Rules<Real>{}.smoothed(w[j], to[j], f[j], a, Real(inv[j]), Real(more),
                                                                     Real(by));
                                   },
                                   put});
        }
    }
}

template <class Real>
void smoothFirstOf(const HostDispatch& d)
{
    const auto&          push    = pushed<SmoothPush>(d);
    const auto*          inverse = bound<const float>(d, 0);
    const auto*          force   = bound<const Real>(d, 1);
    auto*                before  = bound<Real>(d, 2);
    auto*                after   = bound<Real>(d, 3);
    const std::ptrdiff_t nodes   = nodesOf(push.level);
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load)
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < nodes; ++n) {
            before[load * nodes + n] = Real(0.0f);
            after[load * nodes + n]  = Real(push.step) * (force[load * nodes + n] * Real(inverse[n]));
        }
}

} // namespace

PALPATE_ALONE_AND_TOGETHER(residual, float)
PALPATE_ALONE_AND_TOGETHER(relax, float)
PALPATE_ALONE_AND_TOGETHER(relaxFirst, float)
PALPATE_ALONE_AND_TOGETHER(smooth, float)
PALPATE_ALONE_AND_TOGETHER(smoothFirst, float)
PALPATE_REALS_ALONE_AND_TOGETHER(apply)
PALPATE_REALS_ALONE_AND_TOGETHER(start)

} // namespace palp::PALPATE_ISA
