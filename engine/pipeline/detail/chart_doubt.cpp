#include "engine/pipeline/detail/chart_doubt.h"

#include <cmath>

#include "engine/pipeline/detail/whole_object.h"

namespace palp {

double chartDoubt(const Patch& patch)
{
    if (!patch.moved || !patch.curvature || patch.response.values().empty()) return 0;
    constexpr double      kPower = 5;
    const PlateGrid&      grid   = patch.plate.grid;
    const NodeField&      w      = patch.response;
    const CurvatureField& k      = *patch.curvature;
    const double          dx = grid.spacingX, dz = grid.spacingZ;
    const ChartPoint      at     = patch.moved->place;
    double                energy = 0, doubt = 0;
    for (int i = 1; i < grid.cellsX; ++i)
        for (int j = 1; j < grid.cellsZ; ++j) {
            const auto n = std::size_t(i * grid.nodesZ() + j);
            if (!isOnSheet(patch, n) || isHeld(patch, n)) continue;
            const double xx   = (w(i + 1, j) - 2 * w(i, j) + w(i - 1, j)) / (dx * dx);
            const double zz   = (w(i, j + 1) - 2 * w(i, j) + w(i, j - 1)) / (dz * dz);
            const double xz   = (w(i + 1, j + 1) - w(i + 1, j - 1) - w(i - 1, j + 1) + w(i - 1, j - 1)) / (4 * dx * dz);
            const double here = sheetRigidity(patch, n) * (xx * xx + zz * zz + 2 * xz * xz);
            const double gauss = std::abs(k.x(i, j) * k.z(i, j) - k.xz(i, j) * k.xz(i, j));
            const double x = patch.window.corner.x + i * dx - at.x, z = patch.window.corner.z + j * dz - at.z;
            energy += here;
            doubt += here * gauss / 4 * std::hypot(x, z);
        }
    return energy > 0 ? kPower * std::hypot(at.x, at.z) * doubt / energy : 0;
}

} // namespace palp
