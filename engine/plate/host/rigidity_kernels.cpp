#include "engine/plate/host/frame.h"

// The kernels that prepare a rigidity: rigidity_coarsen.comp, jump_mark.comp and jump_list.comp.

namespace palp::PALPATE_ISA {
namespace {

struct Coarsen {
    const float* fine;
    int          stride, shapeAt;

    float fineRigidity(int i, int j) const { return fine[i * stride + j]; }
    float fineShape(int i, int j) const { return fine[shapeAt + i * stride + j]; }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/rigidity_coarsen.h"
};

struct Jumps {
    const float* D;
    int          stride;

    float rigidity(int i, int j) const { return D[i * stride + j]; }

#include "compute_shaders/shared/jump_tiles.h"
};

/// Least and greatest rigidity of each column of some rows.
struct Extremes {
    float *least, *most;

    void over(const float* D, std::ptrdiff_t nodes, int firstRow, int lastRow)
    {
        const float* row = D + firstRow * nodes;
        for (std::ptrdiff_t j = 0; j < nodes; ++j) least[j] = most[j] = row[j];
        for (int i = firstRow + 1; i <= lastRow; ++i) {
            row += nodes;
#pragma GCC ivdep
            for (std::ptrdiff_t j = 0; j < nodes; ++j) {
                least[j] = min(least[j], row[j]);
                most[j]  = max(most[j], row[j]);
            }
        }
    }

    [[nodiscard]] bool vary(int first, int last) const
    {
        float low = least[first], high = most[first];
        for (int j = first + 1; j <= last; ++j) {
            low  = min(low, least[j]);
            high = max(high, most[j]);
        }
        return high > kJump * low;
    }
};

/// Computes a coarse row from a fine one, at nodes of the fine row and their neighbours.
struct MeansAlongZ {
    Coarsen rules;
    int     nodes;               ///< of a coarse row
    int     cells;               ///< of a fine one
    int *   before, *at, *after; ///< places in the fine row of each coarse node

    void find(int coarseCells)
    {
        for (int j = 0; j < nodes; ++j) {
            at[j]     = rules.finePlace(j, cells, coarseCells);
            before[j] = rules.mirrored(at[j] - 1, cells);
            after[j]  = rules.mirrored(at[j] + 1, cells);
        }
    }

    void computeRow(const float* fine, float* __restrict row)
    {
        // Every second node is the usual case, and needs no list of places but at the ends.
        const int  plain  = nodes - 1; // the first and the last may have a mirror image beside them
        const bool halves = cells == 2 * plain;
        for (int j : {0, plain}) row[j] = rules.meanOfThree(fine[before[j]], fine[at[j]], fine[after[j]]);
        if (halves)
            for (int j = 1; j < plain; ++j) row[j] = rules.meanOfThree(fine[2 * j - 1], fine[2 * j], fine[2 * j + 1]);
        else
            for (int j = 1; j < plain; ++j) row[j] = rules.meanOfThree(fine[before[j]], fine[at[j]], fine[after[j]]);
    }
};

} // namespace

// The shader takes means along z within means along x; here those along z are computed once per fine row.
void coarsen(const HostDispatch& d)
{
    static thread_local Scratch<int>   placeScratch;
    static thread_local Scratch<float> rowScratch;
    const auto&                        push = pushed<TransferPush>(d);
    const auto &                       from = push.fine, &to = push.coarse;
    Coarsen                            rules{bound<const float>(d, 0), from.cellsZ + 1, from.shapeAt};
    auto*                              coarse = bound<float>(d, 1);
    const bool                         alongX = to.cellsX != from.cellsX, alongZ = to.cellsZ != from.cellsZ;
    const int                          nodes  = to.cellsZ + 1;
    int* const                         before = placeScratch.of(3 * std::ptrdiff_t(nodes));
    MeansAlongZ                        means{rules, nodes, from.cellsZ, before, before + nodes, before + 2 * nodes};
    means.find(to.cellsZ);
    float* const rows    = rowScratch.of(4 * std::ptrdiff_t(nodes)); // those along z that were made last
    int          made[4] = {-1, -1, -1, -1};
    const auto   rowOf   = [&](int i) {
        float* row = rows + std::ptrdiff_t(i % 4) * nodes;
        if (made[i % 4] == i) return row;
        made[i % 4]       = i;
        const float* fine = rules.fine + std::ptrdiff_t(i) * rules.stride;
        if (alongZ)
            means.computeRow(fine, row);
        else
            for (int j = 0; j < nodes; ++j) row[j] = fine[means.at[j]];
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
    if (to.shapeAt == 0) return;
    for (int i = 0; i <= to.cellsX; ++i)
        for (int j = 0; j < nodes; ++j)
            coarse[to.shapeAt + std::ptrdiff_t(i) * nodes + j] = rules.coarseShapeAt(from, to, i, j);
}

void jumpMark(const HostDispatch& d)
{
    static thread_local Scratch<float> scratch;
    const PlateLevel&                  g     = pushed<LevelPush>(d).level;
    const auto*                        D     = bound<const float>(d, 0);
    auto*                              marks = bound<uint>(d, 1);
    const int                          nodes = g.cellsZ + 1;
    Jumps                              jumps{D, nodes};
    float* const                       rows = scratch.of(2 * std::ptrdiff_t(nodes));
    Extremes                           extremes{rows, rows + nodes};
    for (int i = 0; i < tilesX(g); ++i) {
        // A cheaper test first: the rigidity must vary enough for a jump among all nodes that jumpsInTile() visits,
        // which is rare.
        extremes.over(D, nodes, max(0, i * kTile - 2), min(g.cellsX, (i + 1) * kTile + 1));
        for (int j = 0; j < tilesZ(g); ++j) {
            const bool varies = extremes.vary(max(0, j * kTile - 2), min(g.cellsZ, (j + 1) * kTile + 1));
            *marks++          = varies && jumps.jumpsInTile(g, i, j) ? 1U : 0U;
        }
    }
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
