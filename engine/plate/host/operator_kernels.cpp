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
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        PlainField<Real> field{w + load * nodesOf(g), nodes};
        forEachRow<Real>(g, D, field, [&](int i) {
            Real* to = result + load * nodesOf(g) + std::ptrdiff_t(i) * nodes;
            return RowTo{[](int, Real force) { return force; }, [=](int j, Real force) { to[j] = force; }};
        });
    }
}

/// \param rounded  the same in floats, or null
template <class Real, bool kRounds>
void residualOf(const HostDispatch& d)
{
    const PlateLevel& g       = pushed<LevelPush>(d).level;
    const auto*       D       = bound<const float>(d, 0);
    const auto*       force   = bound<const float>(d, 1);
    const auto*       w       = bound<const Real>(d, 2);
    auto*             result  = bound<Real>(d, 3);
    auto*             rounded = kRounds ? bound<float>(d, 4) : nullptr;
    const int         nodes   = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        PlainField<Real> field{w + load * nodesOf(g), nodes};
        forEachRow<Real>(g, D, field, [&](int i) {
            const std::ptrdiff_t at   = load * nodesOf(g) + std::ptrdiff_t(i) * nodes;
            const float*         f    = force + at;
            Real*                to   = result + at;
            float*               also = rounded + at;
            return RowTo{[=](int j, Real a) { return Real(f[j]) - a; },
                         [=](int j, Real left) {
                             to[j] = left;
                             if (kRounds) also[j] = float(left);
                         }};
        });
    }
}

/// Takes nodes of one colour from one field and the others from another, row by row.
struct TwoColours {
    const float* same;
    const float* other;
    int          nodes;
    unsigned     colour;
    float*       rows; ///< six of them
    int          made = 0;

    const float* row(int i)
    {
        if (same == other) return same + std::ptrdiff_t(i) * nodes;
        for (; made <= i; ++made) {
            const float* a   = same + std::ptrdiff_t(made) * nodes;
            const float* b   = other + std::ptrdiff_t(made) * nodes;
            float*       to  = rows + std::ptrdiff_t(made % 6) * nodes;
            const int    odd = int((unsigned(made) + colour) & 1U);
#pragma GCC ivdep
            for (int j = 0; j < nodes; ++j) to[j] = (j & 1) == odd ? a[j] : b[j];
        }
        return rows + std::ptrdiff_t(i % 6) * nodes;
    }
};

} // namespace

PALPATE_IN_BOTH_PRECISIONS(apply)

void residual(const HostDispatch& d)
{
    residualOf<float, false>(d);
}

void start_f32(const HostDispatch& d)
{
    residualOf<float, true>(d);
}

void start_f64(const HostDispatch& d)
{
    residualOf<double, true>(d);
}

void relax(const HostDispatch& d)
{
    const auto& [g, colour] = pushed<RelaxPush>(d);
    const auto* D           = bound<const float>(d, 0);
    const auto* inverse     = bound<const float>(d, 1);
    const auto* force       = bound<const float>(d, 2);
    const auto* same        = bound<const float>(d, 3);
    const auto* other       = bound<const float>(d, 4);
    auto*       after       = bound<float>(d, 5);
    const int   nodes       = g.cellsZ + 1;

    static thread_local Scratch<float> scratch;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const std::ptrdiff_t first = load * nodesOf(g);
        TwoColours field{same + first, other + first, nodes, colour, scratch.of(6 * std::ptrdiff_t(nodes) + 1) + 1};
        OperatorRows<float, TwoColours> rows(g, D, field);
        for (int i = 0; i <= g.cellsX; ++i) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float *        inv = inverse + at, *f = force + first + at, *w = field.row(i);
            float*               to  = after + first + at;
            const int            odd = int((unsigned(i) + colour) & 1U);
            rows.next(i, RowTo{[=](int j, float a) { // the inverse divisor of a held node is 0
                                   const float relaxed = Rules<float>{}.relaxed(w[j], f[j], a, inv[j]);
                                   return (j & 1) == odd ? relaxed : to[j];
                               },
                               [=](int j, float value) { to[j] = value; }});
        }
    }
}

void relaxFirst(const HostDispatch& d)
{
    const auto& [g, colour] = pushed<RelaxPush>(d);
    const auto* inverse     = bound<const float>(d, 0);
    const auto* force       = bound<const float>(d, 1);
    auto*       after       = bound<float>(d, 2);
    const int   nodes       = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load)
        for (int i = 0; i <= g.cellsX; ++i) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float *        inv = inverse + at, *f = force + load * nodesOf(g) + at;
            float*               to  = after + load * nodesOf(g) + at;
            const int            odd = int((unsigned(i) + colour) & 1U);
#pragma GCC ivdep
            for (int j = 0; j < nodes; ++j) to[j] = (j & 1) == odd ? f[j] * inv[j] : to[j];
        }
}

void smooth(const HostDispatch& d)
{
    const auto& [g, ahead, step] = pushed<SmoothPush>(d);
    const auto* D                = bound<const float>(d, 0);
    const auto* inverse          = bound<const float>(d, 1);
    const auto* force            = bound<const float>(d, 2);
    const auto* before           = bound<const float>(d, 3);
    auto*       after            = bound<float>(d, 4);
    const int   nodes            = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const std::ptrdiff_t                   first = load * nodesOf(g);
        PlainField<float>                      field{before + first, nodes};
        OperatorRows<float, PlainField<float>> rows(g, D, field);
        for (int i = 0; i <= g.cellsX; ++i) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float *        inv = inverse + at, *f = force + first + at, *w = field.row(i);
            float*               to  = after + first + at;
            const auto           put = [=](int j, float value) { to[j] = value; };
            if (ahead == 0)
                rows.next(i, RowTo{[=, by = step](int j, float a) {
                                       return Rules<float>{}.smoothed(w[j], w[j], f[j], a, inv[j], 0, by);
                                   },
                                   put});
            else
                rows.next(i, RowTo{[=, more = ahead, by = step](int j, float a) {
                                       return Rules<float>{}.smoothed(w[j], to[j], f[j], a, inv[j], more, by);
                                   },
                                   put});
        }
    }
}

void smoothFirst(const HostDispatch& d)
{
    const auto&          push    = pushed<SmoothPush>(d);
    const auto*          inverse = bound<const float>(d, 0);
    const auto*          force   = bound<const float>(d, 1);
    auto*                before  = bound<float>(d, 2);
    auto*                after   = bound<float>(d, 3);
    const std::ptrdiff_t nodes   = nodesOf(push.level);
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load)
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < nodes; ++n) {
            before[load * nodes + n] = 0;
            after[load * nodes + n]  = push.step * (force[load * nodes + n] * inverse[n]);
        }
}

} // namespace palp::PALPATE_ISA
