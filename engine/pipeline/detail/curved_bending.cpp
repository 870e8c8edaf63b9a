#include "engine/pipeline/detail/curved_bending.h"

#include <algorithm>
#include <cmath>

#include "engine/pipeline/detail/bending.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

/// Returns the mean of a field over the sheet.
double meanOf(const NodeField& field, const NodeField& covered)
{
    double sum = 0, all = 0;
    for (std::size_t n = 0; n < field.values().size(); ++n) {
        sum += covered.values()[n] * field.values()[n];
        all += covered.values()[n];
    }
    return all > 0 ? sum / all : 0;
}

} // namespace

double curvedBending(const Patch& patch, double compliance)
{
    if (!patch.curvature || patch.covered.values().empty()) return 1;
    constexpr double kSofter = 0.25, kStiffer = 1; // [1]
    const PlateGrid& grid = patch.plate.grid;
    const double     nu   = patch.plate.poissonRatio;
    const double     kx = meanOf(patch.curvature->x, patch.covered), kz = meanOf(patch.curvature->z, patch.covered);
    const double     kxz   = meanOf(patch.curvature->xz, patch.covered);
    const double     gauss = std::abs(kx * kz - kxz * kxz), mean = (kx + kz) / 2;
    if (!(gauss < mean * mean)) return 1;
    const double oneWay = 1 - gauss / (mean * mean); // 1: curved one way, 0: as much both ways
    const double xx = oneWay * (kx * kx + kxz * kxz), zz = oneWay * (kz * kz + kxz * kxz); // of k^2 [1/m^2]
    const double xz   = oneWay * kxz * (kx + kz);
    double       work = 0; // [m/N]
    for (int i = 1; i < grid.cellsX; ++i)
        for (int j = 1; j < grid.cellsZ; ++j) {
            if (!(patch.covered(i, j) > 0)) continue;
            const Bending of       = Bending::at(grid, patch.response, i, j);
            const double  rigidity = sheetRigidity(patch, std::size_t(i * grid.nodesZ() + j));
            const double  along =
                (1 - nu) * (of.xx * xx + of.zz * zz + 2 * of.xz * xz) + nu * (of.xx + of.zz) * (xx + zz);
            work += patch.covered(i, j) * rigidity * along * patch.response(i, j) * grid.spacingX * grid.spacingZ;
        }
    const double share = std::clamp(2 * work / compliance, -kSofter, kStiffer);
    return 1 / (1 + share);
}

} // namespace palp
