#include <type_traits>
#include <utility>

#include "engine/plate/host/frame.h"
#include "engine/plate/host/rim_view.h"

// Entries of the operator's matrix: plate_divisor.comp and coarse_assemble.comp. They are the operator's answers to
// unit deflections, so that there is no second list of them.
//
// Where a node's place is a constant, all but one of 13 deflections are a constant 0, and the operator reduces to the
// closed form of an entry. A compiler may drop products with 0 and sums with it only if no number is infinite or NaN
// and zeros have no sign; this file alone is compiled so (see CMakeLists.txt). Rigidities are finite, so the entries
// are the same to the bit, but for the sign of an entry of 0, which affects no divisor and no factor. This file must
// not test for numbers that are not finite.

namespace palp::PALPATE_ISA {

void rimEntries(const PlateLevel& g, const float* D, const RimView& rim, float* to);
void rimEntries(const PlateLevel& g, const float* D, const RimView& rim, double* to);

namespace {

/// Entries of the operator's row at a node; places count from `at`, the rigidity there.
template <class Real>
struct Row {
    using real = Real;

    const float*   at;
    std::ptrdiff_t stride;
    std::ptrdiff_t shapeAt;        ///< see PlateLevel
    int            placeI, placeJ; ///< the node's name
    int            unitI = 0, unitJ = 0;

    real rigidity(int i, int j) const { return real(at[(i - placeI) * stride + (j - placeJ)]); }
    real foundationShape(int i, int j) const { return real(at[shapeAt + (i - placeI) * stride + (j - placeJ)]); }
    real deflection(int i, int j) const { return i == unitI && j == unitJ ? real(1) : real(0); }
    real otherColour(int i, int j) const { return deflection(i, j); }

#include "compute_shaders/shared/plate_divisor.h"
#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
};

// Places along an axis that differ in their rules: the three next to either side, whose row of the operator or a
// neighbour in it touches that side, and all others. They are named as on an axis of eight cells:
//
//     0   1   2   3 ... n-3   n-2   n-1    n      of n >= 6 cells
//     0   1   2       4        6     7     8
constexpr int kPlaceCells = 8, kMiddle = 4, kNear = 3;
using Places = std::integer_sequence<int, 0, 1, 2, kMiddle, 6, 7, 8>;

bool isNarrow(const PlateLevel& g)
{
    return g.cellsX < 2 * kNear || g.cellsZ < 2 * kNear; // a node is next to two opposite sides
}

PlateLevel named(PlateLevel g)
{
    g.cellsX = g.cellsZ = kPlaceCells;
    return g;
}

/// The nodes of an axis that have one name.
struct Nodes {
    int first, end;

    Nodes(int place, int cells)
        : first(place < kMiddle   ? place
                : place > kMiddle ? cells - (kPlaceCells - place)
                                  : kNear),
          end(place == kMiddle ? cells + 1 - kNear : first + 1)
    {
    }
};

/// A node whose name is a constant. (Not always_inline: that would keep it from being flattened into its caller.)
template <int placeI, int placeJ>
float inverseDivisor(const PlateLevel& level, const float* at, std::ptrdiff_t stride)
{
    Row<float> row{at, stride, level.shapeAt, placeI, placeJ};
    if (row.isHeld(level, placeI, placeJ)) return 0;
    float others = 0;
    // The sum of plate_divisor.comp, each entry with its own constant.
    const auto add = [&]<int... m>(std::integer_sequence<int, m...>)
    {
        ((others += row.entryOf(level, placeI, placeJ, m)), ...);
    };
    add(std::make_integer_sequence<int, 8>{});
    return 1.0F / row.relaxationDivisor(row.entryOf(level, placeI, placeJ, 8), others);
}

template <int placeI, int placeJ>
[[gnu::flatten]] void divisorsOf(const PlateLevel& g, const float* D, float* __restrict to)
{
    const PlateLevel     level  = named(g);
    const std::ptrdiff_t stride = g.cellsZ + 1;
    const Nodes          rows(placeI, g.cellsX), columns(placeJ, g.cellsZ);
    for (int i = rows.first; i < rows.end; ++i)
        for (int j = columns.first; j < columns.end; ++j)
            to[i * stride + j] = inverseDivisor<placeI, placeJ>(level, D + i * stride + j, stride);
}

template <int placeI, int... placeJ>
void divisorsOfRows(const PlateLevel& g, const float* D, float* to, std::integer_sequence<int, placeJ...>)
{
    (divisorsOf<placeI, placeJ>(g, D, to), ...);
}

template <int... placeI>
void divisorsOfAll(const PlateLevel& g, const float* D, float* to, std::integer_sequence<int, placeI...> places)
{
    (divisorsOfRows<placeI>(g, D, to, places), ...);
}

void divisorsOfNarrow(const PlateLevel& g, const float* D, float* to)
{
    for (int i = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j, ++D) {
            Row<float> row{D, g.cellsZ + 1, g.shapeAt, i, j};
            *to++ = row.isHeld(g, i, j) ? 0.0F : 1.0F / row.divisorAt(g, i, j);
        }
}

/// The coarsest level's matrix: the lower triangle, column by column.
template <class Real>
struct Band {
    Real*          entries;
    std::ptrdiff_t nodesX, nodesZ;
    std::ptrdiff_t reach; ///< half band
    bool           zIsFast;

    Band(const PlateLevel& g, Real* to)
        : entries(to), nodesX(g.cellsX + 1), nodesZ(g.cellsZ + 1), reach(halfBand(g)), zIsFast(zIsShorter(g))
    {
    }
    [[nodiscard]] std::ptrdiff_t unknown(int i, int j) const { return zIsFast ? i * nodesZ + j : j * nodesX + i; }
};

/// Writes the entries of the nodes of one name that are not above the diagonal. Those of held nodes are unchanged.
template <int placeI, int placeJ, class Real>
[[gnu::flatten]] void assembleRows(const PlateLevel& g, const float* D, const Band<Real>& band)
{
    const PlateLevel     level  = named(g);
    const std::ptrdiff_t stride = g.cellsZ + 1;
    const Nodes          rows(placeI, g.cellsX), columns(placeJ, g.cellsZ);
    for (int i = rows.first; i < rows.end; ++i)
        for (int j = columns.first; j < columns.end; ++j) {
            Row<Real> row{D + i * stride + j, stride, g.shapeAt, placeI, placeJ};
            if (row.isHeld(level, placeI, placeJ)) continue;
            const auto entry = [&]<int di, int dj>(std::integer_sequence<int, di, dj>) {
                constexpr int unitI = placeI + di, unitJ = placeJ + dj;
                if constexpr (unitI >= 0 && unitI <= kPlaceCells && unitJ >= 0 && unitJ <= kPlaceCells) {
                    const std::ptrdiff_t column = band.unknown(i + di, j + dj), offset = band.unknown(i, j) - column;
                    if (offset < 0 || row.isHeld(level, unitI, unitJ)) return;
                    row.unitI                                        = unitI;
                    row.unitJ                                        = unitJ;
                    band.entries[column * (band.reach + 1) + offset] = row.operatorAt(level, placeI, placeJ);
                }
            };
            entry(std::integer_sequence<int, 0, 0>{});
            entry(std::integer_sequence<int, 0, -1>{});
            entry(std::integer_sequence<int, 0, -2>{});
            entry(std::integer_sequence<int, -1, -1>{});
            entry(std::integer_sequence<int, -1, 0>{});
            entry(std::integer_sequence<int, -1, 1>{});
            entry(std::integer_sequence<int, 1, -1>{});
            entry(std::integer_sequence<int, -2, 0>{});
        }
}

template <int placeI, class Real, int... placeJ>
void assembleColumns(const PlateLevel& g, const float* D, const Band<Real>& band, std::integer_sequence<int, placeJ...>)
{
    (assembleRows<placeI, placeJ>(g, D, band), ...);
}

template <class Real, int... placeI>
void assembleAll(const PlateLevel& g, const float* D, const Band<Real>& band,
                 std::integer_sequence<int, placeI...> places)
{
    (assembleColumns<placeI>(g, D, band, places), ...);
}

template <class Real>
void assembleNarrow(const PlateLevel& g, const float* D, const Band<Real>& band)
{
    Row<Real>  row{D, g.cellsZ + 1, g.shapeAt, 0, 0};
    const auto isNear = [&](int i, int j) { return abs(i - row.unitI) + abs(j - row.unitJ) <= 2; };
    for (int i = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j)
            for (row.unitI = 0; row.unitI <= g.cellsX; ++row.unitI)
                for (row.unitJ = 0; row.unitJ <= g.cellsZ; ++row.unitJ) {
                    const std::ptrdiff_t column = band.unknown(row.unitI, row.unitJ);
                    const std::ptrdiff_t offset = band.unknown(i, j) - column;
                    if (offset >= 0 && isNear(i, j) && !row.isHeld(g, i, j) && !row.isHeld(g, row.unitI, row.unitJ))
                        band.entries[column * (band.reach + 1) + offset] = row.operatorAt(g, i, j);
                }
}

template <class Real>
void assembleOf(const HostDispatch& d)
{
    const PlateLevel&    g = pushed<LevelPush>(d).level;
    const auto*          D = bound<const float>(d, 0);
    const Band<Real>     band(g, bound<Real>(d, 1));
    const std::ptrdiff_t slots = band.reach + 1;
    for (std::ptrdiff_t n = 0; n < slots * nodesOf(g); ++n) band.entries[n] = 0;
    for (std::ptrdiff_t n = 0; n < nodesOf(g); ++n) band.entries[n * slots] = 1;
    if (isNarrow(g)) return assembleNarrow(g, D, band);
    assembleAll(g, D, band, Places{});
}

/// Writes the rows of a rim's nodes: eight numbers each, the diagonal, the entries of the six neighbours before it in
/// the order of rim_kernels.cpp, and one that is not used.
template <class Real>
void rimEntriesOf(const PlateLevel& g, const float* D, const RimView& rim, Real* to)
{
    const PlateLevel     level  = named(g);
    const std::ptrdiff_t stride = g.cellsZ + 1;
    for (int n = 0; n < rim.unknowns; ++n, to += 8) {
        const int i = rim.nodes[n] / int(stride), j = rim.nodes[n] % int(stride);
        if (i >= kNear && j >= kNear && i <= g.cellsX - kNear && j <= g.cellsZ - kNear) {
            Row<Real>  row{D + rim.nodes[n], stride, g.shapeAt, kMiddle, kMiddle};
            const auto entry = [&]<int di, int dj>(std::integer_sequence<int, di, dj>) {
                row.unitI = kMiddle + di;
                row.unitJ = kMiddle + dj;
                return row.operatorAt(level, kMiddle, kMiddle);
            };
            to[0] = entry(std::integer_sequence<int, 0, 0>{});
            to[1] = entry(std::integer_sequence<int, 0, -1>{});
            to[2] = entry(std::integer_sequence<int, 0, -2>{});
            to[3] = entry(std::integer_sequence<int, -1, -1>{});
            to[4] = entry(std::integer_sequence<int, -1, 0>{});
            to[5] = entry(std::integer_sequence<int, -1, 1>{});
            to[6] = entry(std::integer_sequence<int, -2, 0>{});
            continue;
        }
        constexpr int kPlaces[7][2] = {{0, 0}, {0, -1}, {0, -2}, {-1, -1}, {-1, 0}, {-1, 1}, {-2, 0}};
        Row<Real>     row{D, stride, g.shapeAt, 0, 0};
        for (int m = 0; m < 7; ++m) {
            row.unitI = i + kPlaces[m][0];
            row.unitJ = j + kPlaces[m][1];
            to[m]     = row.unitI >= 0 && row.unitJ >= 0 && row.unitJ <= g.cellsZ ? row.operatorAt(g, i, j) : Real(0);
        }
    }
}

} // namespace

[[gnu::flatten]] void rimEntries(const PlateLevel& g, const float* D, const RimView& rim, float* to)
{
    rimEntriesOf(g, D, rim, to);
}
[[gnu::flatten]] void rimEntries(const PlateLevel& g, const float* D, const RimView& rim, double* to)
{
    rimEntriesOf(g, D, rim, to);
}

void divisor(const HostDispatch& d)
{
    const PlateLevel& g  = pushed<LevelPush>(d).level;
    const auto*       D  = bound<const float>(d, 0);
    auto*             to = bound<float>(d, 1);
    if (isNarrow(g)) return divisorsOfNarrow(g, D, to);
    divisorsOfAll(g, D, to, Places{});
}

PALPATE_IN_BOTH_PRECISIONS(assemble)

} // namespace palp::PALPATE_ISA
