#include "engine/plate/host/kernels.h"
#include "engine/plate/host/operator_rows.h"

// plate_apply.comp, plate_residual.comp and plate_relax.comp.

namespace palp::PALPATE_ISA {
namespace {

/// Calls visit(i, forces of row i) for every row of A w.
template <class Real, class Field, class Visit>
void forEachRow(const PlateLevel& g, const float* D, Field& field, Visit&& visit)
{
    static thread_local Scratch<Real> scratch;
    Real*                             forces = scratch.of(g.cellsZ + 1);
    OperatorRows<Real, Field>         rows(g, D, field);
    for (int i = 0; i <= g.cellsX; ++i) {
        rows.next(i, forces);
        visit(i, forces);
    }
}

/// Whether all nodes of a row but perhaps its ends are held.
bool isHeldRow(const PlateLevel& g, int i)
{
    return Rules<float>{}.isHeld(middleOfZ(g), i, kMiddle);
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
        Real*            out = result + load * nodesOf(g);
        forEachRow<Real>(g, D, field, [&](int i, const Real* forces) {
            Real* to = out + std::ptrdiff_t(i) * nodes;
            if (isHeldRow(g, i))
                for (int j = 0; j < nodes; ++j) to[j] = 0;
            else
                for (int j = 0; j < nodes; ++j) to[j] = forces[j];
            for (int j : {0, nodes - 1})
                if (Rules<Real>{}.isHeld(g, i, j)) to[j] = 0;
        });
    }
}

/// \param rounded  the same in floats, or null
template <class Real>
void residualOf(const HostDispatch& d, float* rounded)
{
    const PlateLevel& g      = pushed<LevelPush>(d).level;
    const auto*       D      = bound<const float>(d, 0);
    const auto*       force  = bound<const float>(d, 1);
    const auto*       w      = bound<const Real>(d, 2);
    auto*             result = bound<Real>(d, 3);
    const int         nodes  = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        PlainField<Real> field{w + load * nodesOf(g), nodes};
        forEachRow<Real>(g, D, field, [&](int i, const Real* forces) {
            const std::ptrdiff_t at = load * nodesOf(g) + std::ptrdiff_t(i) * nodes;
            const float*         f  = force + at;
            Real*                to = result + at;
            if (isHeldRow(g, i))
                for (int j = 0; j < nodes; ++j) to[j] = 0;
            else
#pragma GCC ivdep
                for (int j = 0; j < nodes; ++j) to[j] = Real(f[j]) - forces[j];
            for (int j : {0, nodes - 1})
                if (Rules<Real>{}.isHeld(g, i, j)) to[j] = 0;
            if (rounded)
#pragma GCC ivdep
                for (int j = 0; j < nodes; ++j) rounded[at + j] = float(to[j]);
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
    residualOf<float>(d, nullptr);
}

void start_f32(const HostDispatch& d)
{
    residualOf<float>(d, bound<float>(d, 4));
}

void start_f64(const HostDispatch& d)
{
    residualOf<double>(d, bound<float>(d, 4));
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
        forEachRow<float>(g, D, field, [&, parity = colour](int i, const float* forces) {
            const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
            const float *        inv = inverse + at, *f = force + first + at, *w = field.row(i);
            float*               to  = after + first + at;
            const int            odd = int((unsigned(i) + parity) & 1U);
#pragma GCC ivdep
            for (int j = 0; j < nodes; ++j) {
                const float relaxed = Rules<float>{}.relaxed(w[j], f[j], forces[j], inv[j]);
                to[j]               = (j & 1) == odd ? relaxed : to[j];
            }
        });
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

} // namespace palp::PALPATE_ISA
