#pragma once
#include <algorithm>

#include "engine/plate/shell.h"

namespace palp {

/// Returns the middle half of a shell's window as a strip along x: beyond its borders there is next to nothing, a bed
/// holds the stresses, and they may differ by thrusts.
inline Shell stripOf(Shell shell, double rest = 3e-3)
{
    const PlateGrid& grid = shell.bending.grid;
    const double     area = grid.spacingX * grid.spacingZ;
    const int        low = grid.cellsZ / 4, high = grid.cellsZ - low; // nodes of the borders
    NodeField        one(grid), x(grid), z(grid);
    shell.stressEdges = {Edge::free, Edge::free, Edge::free, Edge::free};
    shell.stressBed   = NodeField(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            const double t = std::clamp(double(j - low + 1) / (high - low + 2), 0.0, 1.0);
            one(i, j)      = t * t * (3 - 2 * t);
            x(i, j)        = one(i, j) * (2.0 * i / grid.cellsX - 1);
            z(i, j)        = one(i, j) * (2.0 * j / grid.cellsZ - 1);
            if (j >= low && j <= high) continue;
            shell.bending.rigidity(i, j) *= rest;
            shell.stressBed(i, j) = 270 * shell.membraneCompliance(i, j) / (area * area);
        }
    shell.thrusts = {one, x, z};
    return shell;
}

} // namespace palp
