#include <type_traits>

#include "engine/plate/host/frame.h"
#include "engine/plate/host/kernels.h"
#include "engine/plate/host/operator_rows.h"

// What a rigidity is prepared by: rigidity_coarsen.comp, plate_divisor.comp, jump_mark.comp and jump_list.comp.

namespace palp::PALPATE_ISA {
namespace {

struct Coarsen {
    const float* fine;
    int          stride;

    float fineRigidity(int i, int j) const { return fine[i * stride + j]; }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/rigidity_coarsen.h"
};

/// Entries of the operator's row at a node; places count from `at`, the rigidity there.
struct Row {
    using real = float;

    const float* at;
    int          stride;
    int          placeI, placeJ; ///< what the node is called
    int          unitI = 0, unitJ = 0;

    float rigidity(int i, int j) const { return at[(i - placeI) * stride + (j - placeJ)]; }
    float deflection(int i, int j) const { return i == unitI && j == unitJ ? 1.0F : 0.0F; }
    float otherColour(int i, int j) const { return deflection(i, j); }

#include "compute_shaders/shared/plate_divisor.h"
#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
};

struct Jumps {
    const float* D;
    int          stride;

    float rigidity(int i, int j) const { return D[i * stride + j]; }

    /// Whether the rigidity varies enough for a jump among all nodes that jumpsInTile() looks at: cheaper, and mostly
    /// no.
    bool variesInReach(const PlateLevel& g, int tileI, int tileJ) const
    {
        const int firstI = max(0, tileI * kTile - 2), lastI = min(g.cellsX, (tileI + 1) * kTile + 1);
        const int firstJ = max(0, tileJ * kTile - 2), lastJ = min(g.cellsZ, (tileJ + 1) * kTile + 1);
        float     least = D[firstI * stride + firstJ], most = least;
        for (int i = firstI; i <= lastI; ++i)
            for (int j = firstJ; j <= lastJ; ++j) {
                least = min(least, D[i * stride + j]);
                most  = max(most, D[i * stride + j]);
            }
        return most > kJump * least;
    }

#include "compute_shaders/shared/jump_tiles.h"
};

/// The divisor of node (placeI, placeJ) of a level, whose rigidity is at `at`.
[[gnu::always_inline]] inline float inverseDivisor(const PlateLevel& g, const float* at, int stride, int placeI,
                                                   int placeJ)
{
    Row row{at, stride, placeI, placeJ};
    return row.isHeld(g, placeI, placeJ) ? 0.0F : 1.0F / row.divisorAt(g, placeI, placeJ);
}

/// Divisors of columns of a row; `level` and `place` say what its nodes are like, a constant where it has no sides.
template <bool kInside>
[[gnu::flatten]] void divisorsOfRow(PlateLevel level, int place, const float* D, int stride, int first, int end,
                                    float* __restrict to)
{
    level.cellsZ = kMiddleCells;
    if (kInside) {
        level.cellsX = kMiddleCells;
        place        = kMiddle;
    }
    if (!kInside && Rules<float>{}.isHeld(level, place, kMiddle)) {
        for (int j = first; j < end; ++j) to[j] = 0;
        return;
    }
    // Unit by unit, so that within a loop each deflection is a constant.
    for (int j = first; j < end; ++j) to[j] = 0;
    const auto add = [&]<int m>(std::integral_constant<int, m>) {
        for (int j = first; j < end; ++j)
            to[j] += Row{D + j, stride, place, kMiddle}.sameColourEntry(level, place, kMiddle, m);
    };
    add(std::integral_constant<int, 0>{});
    add(std::integral_constant<int, 1>{});
    add(std::integral_constant<int, 2>{});
    add(std::integral_constant<int, 3>{});
    add(std::integral_constant<int, 4>{});
    add(std::integral_constant<int, 5>{});
    add(std::integral_constant<int, 6>{});
    add(std::integral_constant<int, 7>{});
    for (int j = first; j < end; ++j) {
        Row row{D + j, stride, place, kMiddle};
        to[j] = 1.0F / row.relaxationDivisor(row.diagonalEntry(level, place, kMiddle), to[j]);
    }
}

} // namespace

// The shader takes means along z within means along x; here those along z are made once per fine row.
void coarsen(const HostDispatch& d)
{
    static thread_local Scratch<int>   placeScratch;
    static thread_local Scratch<float> rowScratch;
    const auto&                        push = pushed<TransferPush>(d);
    const auto &                       from = push.fine, &to = push.coarse;
    Coarsen                            rules{bound<const float>(d, 0), from.cellsZ + 1};
    auto*                              coarse = bound<float>(d, 1);
    const bool                         alongX = to.cellsX != from.cellsX, alongZ = to.cellsZ != from.cellsZ;
    const int                          nodes  = to.cellsZ + 1;
    int* const                         before = placeScratch.of(3 * std::ptrdiff_t(nodes));
    int* const                         at     = before + nodes;
    int* const                         after  = at + nodes;
    for (int j = 0; j < nodes; ++j) {
        at[j]     = rules.finePlace(j, from.cellsZ, to.cellsZ);
        before[j] = rules.mirrored(at[j] - 1, from.cellsZ);
        after[j]  = rules.mirrored(at[j] + 1, from.cellsZ);
    }
    float* const rows    = rowScratch.of(4 * std::ptrdiff_t(nodes)); // those along z that were made last
    int          made[4] = {-1, -1, -1, -1};
    const auto   rowOf   = [&](int i) {
        float* row = rows + std::ptrdiff_t(i % 4) * nodes;
        if (made[i % 4] == i) return row;
        made[i % 4]       = i;
        const float* fine = rules.fine + std::ptrdiff_t(i) * rules.stride;
        if (alongZ)
            for (int j = 0; j < nodes; ++j) row[j] = rules.meanOfThree(fine[before[j]], fine[at[j]], fine[after[j]]);
        else
            for (int j = 0; j < nodes; ++j) row[j] = fine[at[j]];
        return row;
    };
    for (int i = 0; i <= to.cellsX; ++i) {
        const int    place = rules.finePlace(i, from.cellsX, to.cellsX);
        const float* here  = rowOf(place);
        float*       out   = coarse + std::ptrdiff_t(i) * nodes;
        if (!alongX) {
            for (int j = 0; j < nodes; ++j) out[j] = here[j];
            continue;
        }
        const float* west = rowOf(rules.mirrored(place - 1, from.cellsX));
        const float* east = rowOf(rules.mirrored(place + 1, from.cellsX));
#pragma GCC ivdep
        for (int j = 0; j < nodes; ++j) out[j] = rules.meanOfThree(west[j], here[j], east[j]);
    }
}

void divisor(const HostDispatch& d)
{
    const PlateLevel& g     = pushed<LevelPush>(d).level;
    const auto*       D     = bound<const float>(d, 0);
    auto*             to    = bound<float>(d, 1);
    const int         nodes = g.cellsZ + 1;
    constexpr int     kNear = 3; // columns whose row, or a neighbour in it, touches a side
    for (int i = 0; i <= g.cellsX; ++i) {
        const float* row  = D + std::ptrdiff_t(i) * nodes;
        float*       out  = to + std::ptrdiff_t(i) * nodes;
        const bool   wide = nodes > 2 * kNear;
        if (wide && i >= kNear && i <= g.cellsX - kNear)
            divisorsOfRow<true>(g, i, row, nodes, kNear, nodes - kNear, out);
        else if (wide)
            divisorsOfRow<false>(g, i, row, nodes, kNear, nodes - kNear, out);
        for (int j = 0; j < nodes; ++j)
            if (!wide || j < kNear || j >= nodes - kNear) out[j] = inverseDivisor(g, row + j, nodes, i, j);
    }
}

void jumpMark(const HostDispatch& d)
{
    const PlateLevel& g     = pushed<LevelPush>(d).level;
    auto*             marks = bound<uint>(d, 1);
    Jumps             jumps{bound<const float>(d, 0), g.cellsZ + 1};
    for (int i = 0; i < tilesX(g); ++i)
        for (int j = 0; j < tilesZ(g); ++j)
            *marks++ = jumps.variesInReach(g, i, j) && jumps.jumpsInTile(g, i, j) ? 1U : 0U;
}

void jumpList(const HostDispatch& d)
{
    const PlateLevel& g     = pushed<LevelPush>(d).level;
    const auto*       marks = bound<const uint>(d, 0);
    auto*             list  = bound<uint>(d, 1);
    uint              count = 0;
    for (int n = 0; n < tilesX(g) * tilesZ(g); ++n)
        if (marks[n] == 1U) list[++count] = uint(n);
    list[0] = count < kMostListed ? count : kMostListed;
}

} // namespace palp::PALPATE_ISA
