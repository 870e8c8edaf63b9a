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

#include "compute_shaders/shared/jump_tiles.h"
};

/// The divisor of node (placeI, placeJ) of a level, whose rigidity is at `at`.
[[gnu::always_inline]] inline float inverseDivisor(const PlateLevel& g, const float* at, int stride, int placeI,
                                                   int placeJ)
{
    Row row{at, stride, placeI, placeJ};
    return row.isHeld(g, placeI, placeJ) ? 0.0F : 1.0F / row.divisorAt(g, placeI, placeJ);
}

/// Row i of the divisors; `level` and `place` say what its columns away from the sides are like.
[[gnu::flatten]] void divisorsOfRow(const PlateLevel& level, int place, const float* D, int stride, int first, int end,
                                    float* to)
{
#pragma GCC ivdep
    for (int j = first; j < end; ++j) to[j] = inverseDivisor(level, D + j, stride, place, kMiddle);
}

} // namespace

void coarsen(const HostDispatch& d)
{
    const auto& push   = pushed<TransferPush>(d);
    auto*       coarse = bound<float>(d, 1);
    Coarsen     from{bound<const float>(d, 0), push.fine.cellsZ + 1};
    for (int i = 0; i <= push.coarse.cellsX; ++i)
        for (int j = 0; j <= push.coarse.cellsZ; ++j) *coarse++ = from.coarseRigidityAt(push.fine, push.coarse, i, j);
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
        if (wide) {
            PlateLevel like  = middleOfZ(g);
            int        place = i;
            if (i >= kNear && i <= g.cellsX - kNear) {
                like.cellsX = kMiddleCells;
                place       = kMiddle;
                divisorsOfRow(like, kMiddle, row, nodes, kNear, nodes - kNear, out);
            } else {
                divisorsOfRow(like, place, row, nodes, kNear, nodes - kNear, out);
            }
        }
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
        for (int j = 0; j < tilesZ(g); ++j) *marks++ = jumps.jumpsInTile(g, i, j) ? 1U : 0U;
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
