#include "engine/plate/host/kernels.h"
#include "engine/plate/host/operator_rows.h"

// plate_apply.comp, plate_residual.comp and plate_relax.comp.

namespace palp::PALPATE_ISA {
namespace {

/// Whether all nodes of a row but perhaps its ends are held.
bool isHeldRow(const PlateLevel& g, int i)
{
    return Rules<float>{}.isHeld(middleOfZ(g), i, kMiddle);
}

/// Calls visit(row i)(j, A w) for every node; 0 instead for held ones.
template <class Real, class Field, class VisitRow>
void forEachRow(const PlateLevel& g, const float* D, Field& field, VisitRow&& visitRow)
{
    OperatorRows<Real, Field> rows(g, D, field);
    const int                 last = g.cellsZ;
    for (int i = 0; i <= g.cellsX; ++i) {
        const auto visit = visitRow(i);
        rows.next(i, visit.moves);
        if (isHeldRow(g, i))
            for (int j = 1; j < last; ++j) visit.isHeld(j);
        for (int j : {0, last})
            if (Rules<Real>{}.isHeld(g, i, j)) visit.isHeld(j);
    }
}

template <class Moves, class IsHeld>
struct Visit {
    Moves  moves;
    IsHeld isHeld;
};

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
            return Visit{[=](int j, Real force) { to[j] = force; }, [=](int j) { to[j] = 0; }};
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
            const auto           put  = [=](int j, Real left) {
                to[j] = left;
                if (kRounds) also[j] = float(left);
            };
            return Visit{[=](int j, Real a) { put(j, Real(f[j]) - a); }, [=](int j) { put(j, 0); }};
        });
    }
}

/// Nodes of one colour from one field, the others from another, row by row.
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
        TwoColours           field{same + first, other + first, nodes, colour, scratch.of(6 * std::ptrdiff_t(nodes))};
        OperatorRows<float, TwoColours> rows(g, D, field);
        for (int i = 0; i <= g.cellsX; ++i) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float *        inv = inverse + at, *f = force + first + at, *w = field.row(i);
            float*               to  = after + first + at;
            const int            odd = int((unsigned(i) + colour) & 1U);
            rows.next(i, [=](int j, float a) { // the inverse divisor of a held node is 0
                const float relaxed = Rules<float>{}.relaxed(w[j], f[j], a, inv[j]);
                to[j]               = (j & 1) == odd ? relaxed : to[j];
            });
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
            float*               to = after + first + at;
            if (ahead == 0)
                rows.next(i, [=, by = step](int j, float a) {
                    to[j] = Rules<float>{}.smoothed(w[j], w[j], f[j], a, inv[j], 0, by);
                });
            else
                rows.next(i, [=, more = ahead, by = step](int j, float a) {
                    to[j] = Rules<float>{}.smoothed(w[j], to[j], f[j], a, inv[j], more, by);
                });
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
