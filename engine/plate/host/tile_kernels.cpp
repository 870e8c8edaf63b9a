#include "engine/plate/host/tile_runs.h"

// Extra sweeps where the rigidity jumps: plate_relax_tile.comp and plate_copy_tile.comp. Listed tiles that are
// neighbours along z are processed together.

namespace palp::PALPATE_ISA {
namespace {

/// Calls visit(first node of the load's field, first row, last row, columns) for listed tiles.
template <class Real, class Visit>
void forEachRun(const HostDispatch& d, const uint* list, Visit&& visit)
{
    const PlateLevel& g = pushed<RelaxPush>(d).level;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load)
        forEachTileRun(g, list + 1, d.groups.x, [&](int firstI, int lastI, ColumnRange columns) {
            visit(load * nodesOf(g), firstI, lastI, columns);
        });
}

template <class Real>
void relaxTileOf(const HostDispatch& d)
{
    const auto& [g, colour] = pushed<RelaxPush>(d);
    const auto* D           = bound<const float>(d, 0);
    const auto* inverse     = bound<const float>(d, 1);
    const auto* force       = bound<const Real>(d, 2);
    const auto* w           = bound<const Real>(d, 3);
    auto*       aside       = bound<Real>(d, 5);
    const int   nodes       = g.cellsZ + 1;
    forEachRun<Real>(d, bound<const uint>(d, 4),
                     [&, level = g, parity = colour](std::ptrdiff_t first, int i, int lastI, ColumnRange columns) {
                         PlainField<Real>                     field{w + first, nodes};
                         OperatorRows<Real, PlainField<Real>> rows(level, D, field, i, columns);
                         for (; i <= lastI; ++i) {
                             const std::ptrdiff_t at  = std::ptrdiff_t(i) * nodes;
                             const float*         inv = inverse + at;
                             const Real *         f = force + first + at, *before = field.row(i);
                             Real*                to  = aside + first + at;
                             const int            odd = int((unsigned(i) + parity) & 1U);
                             // A row of numbers is a loop without branches. copyTile() ignores the other colour.
                             constexpr bool kAlone  = NodeOf<Real>::kLoads == 1;
                             const auto     relaxes = [odd](int j) { return (j & 1) == odd; };
                             rows.next(i, RowTo{[=](int j, const Real& a) {
                                                    const Real relaxed =
                                                        Rules<Real>{}.relaxed(before[j], f[j], a, Real(inv[j]));
                                                    return !kAlone || relaxes(j) ? relaxed : to[j];
                                                },
                                                [=](int j, const Real& value) {
                                                    if (kAlone || relaxes(j)) to[j] = value;
                                                }});
                         }
                     });
}

template <class Real>
void copyTileOf(const HostDispatch& d)
{
    const auto* aside       = bound<const Real>(d, 1);
    auto*       w           = bound<Real>(d, 2);
    const auto& [g, colour] = pushed<RelaxPush>(d);
    const int nodes         = g.cellsZ + 1;
    forEachRun<Real>(d, bound<const uint>(d, 0),
                     [&, parity = colour](std::ptrdiff_t first, int i, int lastI, ColumnRange columns) {
                         for (; i <= lastI; ++i) {
                             const Real* from = aside + first + std::ptrdiff_t(i) * nodes;
                             Real*       to   = w + first + std::ptrdiff_t(i) * nodes;
                             const int   odd  = int((unsigned(i) + parity) & 1U);
#pragma GCC ivdep
                             for (int j = columns.first; j <= columns.last; ++j)
                                 to[j] = (j & 1) == odd ? from[j] : to[j];
                         }
                     });
}

} // namespace

PALPATE_ALONE_AND_TOGETHER(relaxTile, float)
PALPATE_ALONE_AND_TOGETHER(copyTile, float)

} // namespace palp::PALPATE_ISA
