#pragma once
#include <cmath>
#include <string_view>

#include "engine/plate/load.h"
#include "engine/plate/shell.h"

// The sheets that are pressed deep in tests: 40 mm wide, 1 mm thick, curved by 50 mm.

namespace palp::large_shells {

inline constexpr double kModulus = 1e6, kThickness = 1e-3, kPoisson = 0.3; ///< [Pa], [m], [1]
inline constexpr double kSize = 40e-3, kRadius = 50e-3;                    ///< [m]

inline PlateEdges allSides(Edge edge)
{
    return {edge, edge, edge, edge};
}

/// Held by clamped sides, in its plane as well, or by supported ones.
inline Shell sheet(int cells, double kx, double kz, Edge edge, double nu = kPoisson)
{
    Shell shell;
    shell.bending.grid         = PlateGrid{cells, cells, kSize / cells, kSize / cells};
    shell.bending.edges        = allSides(edge);
    shell.stressEdges          = allSides(edge == Edge::clamped ? Edge::free : Edge::supported);
    shell.bending.poissonRatio = nu;
    shell.bending.rigidity   = NodeField(shell.bending.grid, kModulus * std::pow(kThickness, 3) / (12 * (1 - nu * nu)));
    shell.membraneCompliance = NodeField(shell.bending.grid, 1 / (kModulus * kThickness));
    shell.curvatureX         = NodeField(shell.bending.grid, kx);
    shell.curvatureZ         = NodeField(shell.bending.grid, kz);
    shell.curvatureXZ        = NodeField(shell.bending.grid, 0);
    return shell;
}

/// Makes a Gaussian spot of 4 mm times stiffer, beside the middle by x [m].
inline void addSpot(Shell& shell, double times, double x)
{
    const PlateGrid& g = shell.bending.grid;
    for (int i = 0; i < g.nodesX(); ++i)
        for (int j = 0; j < g.nodesZ(); ++j) {
            const double dx = i * g.spacingX - g.sizeX() / 2 - x, dz = j * g.spacingZ - g.sizeZ() / 2;
            const double stiffer = 1 + (times - 1) * std::exp(-(dx * dx + dz * dz) / (2 * 4e-3 * 4e-3));
            shell.bending.rigidity(i, j) *= stiffer;
            shell.membraneCompliance(i, j) /= stiffer;
        }
}

inline Shell named(std::string_view name, int cells)
{
    const double k = 1 / kRadius;
    if (name == "flat") return sheet(cells, 0, 0, Edge::clamped);
    if (name == "cap ss") return sheet(cells, k, k, Edge::supported);
    if (name == "cap clamped") return sheet(cells, k, k, Edge::clamped);
    if (name == "cylinder") return sheet(cells, 0, k, Edge::clamped);
    if (name == "saddle") return sheet(cells, k, -k, Edge::clamped);
    Shell shell = sheet(cells, k, k, Edge::clamped);
    addSpot(shell, 10, name == "wart" ? 0 : 8e-3);
    return shell;
}

inline NodeField fingertip(const PlateGrid& grid, double radius)
{
    return footprintLoad(grid, 1, grid.sizeX() / 2, grid.sizeZ() / 2, radius);
}

} // namespace palp::large_shells
