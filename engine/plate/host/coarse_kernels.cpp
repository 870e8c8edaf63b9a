#include "engine/plate/host/frame.h"
#include "engine/plate/host/kernels.h"

// The coarsest level: coarse_assemble.comp, coarse_factor.comp and coarse_solve.comp.

namespace palp::PALPATE_ISA {
namespace {

struct Row {
    using real = float;

    const float* D;
    int          stride;
    int          unitI = 0, unitJ = 0;

    float rigidity(int i, int j) const { return D[i * stride + j]; }
    float deflection(int i, int j) const { return i == unitI && j == unitJ ? 1.0F : 0.0F; }
    float otherColour(int i, int j) const { return deflection(i, j); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
};

} // namespace

void assemble(const HostDispatch& d)
{
    const PlateLevel& g    = pushed<LevelPush>(d).level;
    auto*             band = bound<float>(d, 1);
    Row               row{bound<const float>(d, 0), g.cellsZ + 1};
    const int         unknowns = int(nodesOf(g));
    for (int column = 0; column < unknowns; ++column)
        for (int offset = 0; offset <= halfBand(g); ++offset) {
            const int n = column + offset, i = columnOf(g, n), j = rowOf(g, n);
            row.unitI   = columnOf(g, column);
            row.unitJ   = rowOf(g, column);
            float entry = offset == 0 ? 1.0F : 0.0F;
            if (n < unknowns && !row.isHeld(g, i, j) && !row.isHeld(g, row.unitI, row.unitJ))
                entry = abs(i - row.unitI) + abs(j - row.unitJ) <= 2 ? row.operatorAt(g, i, j) : 0.0F;
            *band++ = entry;
        }
}

void factor(const HostDispatch& d)
{
    const PlateLevel& g      = pushed<LevelPush>(d).level;
    const auto*       band   = bound<const float>(d, 0);
    auto*             result = bound<float>(d, 1);
    const int         reach = halfBand(g), slots = reach + 1, unknowns = int(nodesOf(g));

    float window[kMostHalfBand + 1][kMostHalfBand + 1], column[kMostHalfBand + 1];
    for (int n = 0; n < slots; ++n)
        for (int e = 0; e < slots; ++e) window[n][e] = n < unknowns ? band[n * slots + e] : 0.0F;
    for (int n = 0; n < unknowns; ++n) {
        float*      mine    = window[n % slots];
        const float pivot   = mine[0];
        const float inverse = pivot > kLeastPivot * band[n * slots] ? 1.0F / sqrt(pivot) : 0.0F;
        for (int e = 0; e <= reach; ++e) {
            column[e]             = mine[e] * inverse;
            result[n * slots + e] = e == 0 ? inverse : column[e];
        }
        for (int a = 1; a <= reach; ++a) {
            float*      other = window[(n + a) % slots];
            const float along = column[a];
#pragma GCC ivdep
            for (int e = a; e <= reach; ++e) other[e - a] -= along * column[e];
        }
        const int next = n + slots;
        for (int e = 0; e <= reach; ++e) mine[e] = next < unknowns ? band[next * slots + e] : 0.0F;
    }
}

void coarseSolve(const HostDispatch& d)
{
    const PlateLevel& g      = pushed<LevelPush>(d).level;
    const auto*       factor = bound<const float>(d, 0);
    const int         reach = halfBand(g), slots = reach + 1, unknowns = int(nodesOf(g));
    Row               row{};

    float right[kMostCoarseNodes + kMostHalfBand], middle[kMostHalfBand + kMostCoarseNodes];
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const float* force = bound<const float>(d, 1) + load * unknowns;
        float*       w     = bound<float>(d, 2) + load * unknowns;
        const auto   node  = [&](int n) { return columnOf(g, n) * (g.cellsZ + 1) + rowOf(g, n); };
        for (int n = 0; n < unknowns; ++n)
            right[n] = row.isHeld(g, columnOf(g, n), rowOf(g, n)) ? 0.0F : force[node(n)];
        for (int n = 0; n < unknowns; ++n) {
            const float  solved = right[n] * factor[n * slots];
            const float* column = factor + n * slots;
            middle[n]           = solved;
            const int end       = min(reach, unknowns - 1 - n);
#pragma GCC ivdep
            for (int e = 1; e <= end; ++e) right[n + e] -= column[e] * solved;
        }
        for (int n = unknowns - 1; n >= 0; --n) {
            const float solved = middle[n] * factor[n * slots];
            right[n]           = solved;
            for (int e = 1; e <= reach && e <= n; ++e) middle[n - e] -= factor[(n - e) * slots + e] * solved;
        }
        for (int n = 0; n < unknowns; ++n) w[node(n)] = right[n];
    }
}

} // namespace palp::PALPATE_ISA
