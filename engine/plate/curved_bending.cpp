#include "engine/plate/curved_bending.h"

#include <algorithm>
#include <cmath>

namespace palp {
namespace {

/// Returns the mean of a field over the sheet that is free to bend.
double meanOf(const NodeField& field, const Shell& shell)
{
    const bool whole = shell.sheared.values().empty();
    double     sum = 0, all = 0;
    for (std::size_t n = 0; n < field.values().size(); ++n) {
        const double counts = whole ? 1 : shell.sheared.values()[n];
        sum += counts * field.values()[n];
        all += counts;
    }
    return all > 0 ? sum / all : 0;
}

} // namespace

CurvedBending::CurvedBending(const Shell& shell) : plate_(shell.bending)
{
    if (shell.stretched.values().empty()) return;
    const double kx = meanOf(shell.curvatureX, shell), kz = meanOf(shell.curvatureZ, shell);
    const double kxz  = meanOf(shell.curvatureXZ, shell);
    const double both = std::abs(kx * kz - kxz * kxz), mean = (kx + kz) / 2;
    if (!(both < mean * mean)) return;
    const double oneWay = 1 - both / (mean * mean);
    xx_                 = oneWay * (kx * kx + kxz * kxz);
    zz_                 = oneWay * (kz * kz + kxz * kxz);
    xz_                 = oneWay * kxz * (kx + kz);
}

double CurvedBending::workOf(const NodeField& w) const
{
    if (xx_ == 0 && zz_ == 0) return 0;
    const PlateGrid& g = plate_.grid;
    const double nu = plate_.poissonRatio, perX = 1 / (g.spacingX * g.spacingX), perZ = 1 / (g.spacingZ * g.spacingZ);
    const double perXZ = 1 / (4 * g.spacingX * g.spacingZ), trace = nu * (xx_ + zz_);
    double       work = 0;
    for (int i = 1; i < g.cellsX; ++i)
        for (int j = 1; j < g.cellsZ; ++j) {
            const double here = w(i, j);
            const double xx   = (w(i + 1, j) - 2 * here + w(i - 1, j)) * perX;
            const double zz   = (w(i, j + 1) - 2 * here + w(i, j - 1)) * perZ;
            const double xz   = (w(i + 1, j + 1) - w(i + 1, j - 1) - w(i - 1, j + 1) + w(i - 1, j - 1)) * perXZ;
            work +=
                plate_.rigidity(i, j) * here * ((1 - nu) * (xx * xx_ + zz * zz_ + 2 * xz * xz_) + trace * (xx + zz));
        }
    return work * g.spacingX * g.spacingZ;
}

double givesWay(const FootprintResponse& response) noexcept
{
    constexpr double kSofter = 0.25, kStiffer = 1; // [1]
    if (!(response.work > 0)) return 1;
    return 1 / (1 + std::clamp(2 * response.curved / response.work, -kSofter, kStiffer));
}

} // namespace palp
