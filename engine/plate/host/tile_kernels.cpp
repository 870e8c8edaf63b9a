#include "engine/plate/host/frame.h"
#include "engine/plate/host/kernels.h"

// Extra sweeps where the rigidity jumps: plate_relax_tile.comp and plate_copy_tile.comp.

namespace palp::PALPATE_ISA {
namespace {

struct Operator {
    using real = float;

    const float* D;
    const float* w;
    int          stride;

    float rigidity(int i, int j) const { return D[i * stride + j]; }
    float deflection(int i, int j) const { return w[i * stride + j]; }
    float otherColour(int i, int j) const { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
};

/// Calls visit(first node of the load's field, i, j) for every node of the colour in the listed tiles.
template <class Visit>
void forEachNode(const HostDispatch& d, const uint* list, Visit&& visit)
{
    const auto& [g, colour] = pushed<RelaxPush>(d);
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load)
        for (uint n = 0; n < d.groups.x; ++n) {
            const int firstI = int(list[1 + n]) / tilesZ(g) * kTile, firstJ = int(list[1 + n]) % tilesZ(g) * kTile;
            for (int i = firstI; i < min(firstI + kTile, g.cellsX + 1); ++i)
                for (int j = firstJ + int((unsigned(i + firstJ) + colour) & 1U); j < min(firstJ + kTile, g.cellsZ + 1);
                     j += 2)
                    visit(load * nodesOf(g), i, j);
        }
}

} // namespace

void relaxTile(const HostDispatch& d)
{
    const PlateLevel& g       = pushed<RelaxPush>(d).level;
    const auto*       D       = bound<const float>(d, 0);
    const auto*       inverse = bound<const float>(d, 1);
    const auto*       force   = bound<const float>(d, 2);
    const auto*       w       = bound<const float>(d, 3);
    auto*             aside   = bound<float>(d, 5);
    const int         stride  = g.cellsZ + 1;
    forEachNode(d, bound<const uint>(d, 4), [&](std::ptrdiff_t first, int i, int j) {
        Operator  A{D, w + first, stride};
        const int n      = i * stride + j;
        aside[first + n] = A.relaxed(A.deflection(i, j), force[first + n], A.operatorAt(g, i, j), inverse[n]);
    });
}

void copyTile(const HostDispatch& d)
{
    const auto* aside  = bound<const float>(d, 1);
    auto*       w      = bound<float>(d, 2);
    const int   stride = pushed<RelaxPush>(d).level.cellsZ + 1;
    forEachNode(d, bound<const uint>(d, 0), [&](std::ptrdiff_t first, int i, int j) {
        const std::ptrdiff_t n = first + i * stride + j;
        w[n]                   = aside[n];
    });
}

} // namespace palp::PALPATE_ISA
