#include "engine/pipeline/detail/chart_doubt.h"

#include <cmath>

#include "engine/pipeline/detail/bending.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {

double chartDoubt(const Patch& patch)
{
    if (!patch.moved || !patch.curvature || patch.response.values().empty()) return 0;
    constexpr double      kPower = 5;
    const PlateGrid&      grid   = patch.plate.grid;
    const CurvatureField& k      = *patch.curvature;
    const ChartPoint      at     = patch.moved->place;
    double                energy = 0, doubt = 0;
    for (int i = 1; i < grid.cellsX; ++i)
        for (int j = 1; j < grid.cellsZ; ++j) {
            const auto n = std::size_t(i * grid.nodesZ() + j);
            if (!isOnSheet(patch, n) || isHeld(patch, n)) continue;
            const double here =
                sheetRigidity(patch, n) * Bending::at(grid, patch.response, i, j).energy(patch.plate.poissonRatio);
            const double gauss = std::abs(k.x(i, j) * k.z(i, j) - k.xz(i, j) * k.xz(i, j));
            const double x     = patch.window.corner.x + i * grid.spacingX - at.x;
            const double z     = patch.window.corner.z + j * grid.spacingZ - at.z;
            energy += here;
            doubt += here * gauss / 4 * std::hypot(x, z);
        }
    return energy > 0 ? kPower * std::hypot(at.x, at.z) * doubt / energy : 0;
}

} // namespace palp
