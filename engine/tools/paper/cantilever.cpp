#include "engine/tools/paper/cantilever.h"

#include <algorithm>

namespace palp::report {

std::vector<double> cantilever(const Plate& plate, double force)
{
    const PlateGrid& grid    = plate.grid;
    const int        rows    = grid.nodesZ();
    const double     spacing = grid.spacingZ, load = grid.sizeZ() / 2, nu = plate.poissonRatio;
    const auto       curvature = [&](int j) { // [1/m] of the row j
        double stiffness = 0;           // E I [N m^2]
        for (int i = 0; i < grid.nodesX(); ++i)
            stiffness += plate.rigidity(i, j) * (i == 0 || i == grid.cellsX ? 0.5 : 1) * grid.spacingX;
        const double fromRoot = (grid.cellsZ - j) * spacing;
        return force * std::max(0.0, load - fromRoot) / ((1 - nu * nu) * stiffness);
    };
    std::vector<double> w(std::size_t(rows), 0.0);
    double              slope = 0, before = curvature(rows - 1);
    for (int j = rows - 2; j >= 0; --j) {
        const double here = curvature(j), next = slope + 0.5 * (before + here) * spacing;
        w[std::size_t(j)] = w[std::size_t(j) + 1] + 0.5 * (slope + next) * spacing;
        slope             = next;
        before            = here;
    }
    return w;
}

} // namespace palp::report
