#include "engine/pipeline/detail/border_twist.h"

#include <algorithm>
#include <cmath>

#include "engine/pipeline/detail/bending.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {

double borderTwist(const Patch& patch)
{
    if (patch.inside.values().empty()) return 0;
    constexpr double kRim   = 0.315; // thicknesses
    constexpr double kIn    = 2;     // cells within the border, where all differences are those of the sheet
    constexpr double kHeld  = 1e-3;  // share of a node that is held [1]
    const PlateGrid& grid   = patch.plate.grid;
    const NodeField& inside = patch.inside;
    const double     dx = grid.spacingX, dz = grid.spacingZ, cell = std::max(dx, dz);
    double           sum = 0; // of D w_nt^2 along the border [m/N]
    for (int i = 1; i < grid.cellsX; ++i)
        for (int j = 1; j < grid.cellsZ; ++j) {
            const double near = 1 - std::abs(inside(i, j) / cell - kIn); // a hat, whose integral is a cell
            if (!(near > 0) || (!patch.held.values().empty() && patch.held(i, j) > kHeld)) continue;
            const double x       = (inside(i + 1, j) - inside(i - 1, j)) / (2 * dx);
            const double z       = (inside(i, j + 1) - inside(i, j - 1)) / (2 * dz);
            const double length2 = x * x + z * z; // of what points away from the border [1]
            if (!(length2 > 0)) continue;
            const Bending of    = Bending::at(grid, patch.response, i, j);
            const double  twist = ((of.zz - of.xx) * x * z + of.xz * (x * x - z * z)) / length2;
            sum += near * dx * dz / cell * sheetRigidity(patch, std::size_t(i * grid.nodesZ() + j)) * twist * twist;
        }
    return kRim * patch.thickness * 2 * (1 - patch.plate.poissonRatio) * sum;
}

} // namespace palp
