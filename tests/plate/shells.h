#pragma once
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/plate/load.h"
#include "engine/plate/shell.h"

// Shells of some maps and curvatures, for tests of what solves them.

namespace palp {

inline constexpr double kSize     = 40e-3; ///< of the window [m]
inline constexpr double kPoisson  = 0.45;  ///< [1]
inline constexpr double kRigidity = 1e-4;  ///< of the softest part [N m]

using Map = std::function<double(double x, double z)>; ///< over the window's size, from -1/2 to 1/2

inline Map even()
{
    return [](double, double) { return 1.0; };
}
inline Map linear(double contrast)
{
    return [=](double x, double) { return 1 + (contrast - 1) * (x + 0.5); };
}
inline Map wart(double contrast)
{
    return [=](double x, double z) {
        const double squared = std::pow(x - 0.05, 2) + std::pow(z + 0.05, 2);
        return 1 + (contrast - 1) * std::exp(-squared / (2 * 0.06 * 0.06));
    };
}
inline Map disc(double contrast)
{
    return [=](double x, double z) { return std::hypot(x - 0.05, z + 0.05) < 0.15 ? contrast : 1; };
}

inline PlateEdges allSides(Edge edge)
{
    return {edge, edge, edge, edge};
}

struct Bend {
    Map x, z, xz; ///< over the curvature that the length stands for [1]
};

/// A shell whose modulus varies, so that the compliance of its membrane is the inverse of its rigidity.
/// \param lengths  window over the shell's length; 0: flat
inline Shell shellOf(PlateGrid grid, const Map& modulus, const Bend& bend, double lengths,
                     Edge bending = Edge::supported, Edge stress = Edge::supported)
{
    // l^4 = D C / k^2 with C the compliance of the membrane: any C serves, as long as k goes with it.
    const double compliance = 1e-3, curvature = std::sqrt(kRigidity * compliance) * std::pow(lengths / kSize, 2);
    Shell        shell;
    shell.bending.grid         = grid;
    shell.bending.edges        = allSides(bending);
    shell.stressEdges          = allSides(stress);
    shell.bending.poissonRatio = kPoisson;
    shell.bending.rigidity = shell.membraneCompliance = shell.curvatureX = shell.curvatureZ = shell.curvatureXZ =
        NodeField(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            const double x = double(i) / grid.cellsX - 0.5, z = double(j) / grid.cellsZ - 0.5;
            shell.bending.rigidity(i, j)   = kRigidity * modulus(x, z);
            shell.membraneCompliance(i, j) = compliance / modulus(x, z);
            shell.curvatureX(i, j)         = curvature * bend.x(x, z);
            shell.curvatureZ(i, j)         = curvature * bend.z(x, z);
            shell.curvatureXZ(i, j)        = curvature * bend.xz(x, z);
        }
    return shell;
}

inline PlateGrid square(int cells)
{
    return {cells, cells, kSize / cells, kSize / cells};
}

inline Bend constant(double x, double z, double xz)
{
    return {[=](double, double) { return x; }, [=](double, double) { return z; }, [=](double, double) { return xz; }};
}

/// Ridges across the window, five sixths of a wave to each side, aslant.
inline Bend ridges()
{
    const Map wave = [](double x, double z) { return std::cos(2 * std::numbers::pi * (5.0 / 3 * x + 0.5 * z + 0.1)); };
    return {wave, [=](double x, double z) { return 0.1 * wave(x, z); },
            [=](double x, double z) { return 0.3 * wave(x, z); }};
}

/// Returns the shell as one that ends within the window, aslant: beyond its border the rigidity is 3e-3 and a bed holds
/// the stresses, as of objects that end.
inline Shell cutAslant(Shell shell)
{
    const PlateGrid& grid = shell.bending.grid;
    const double     area = grid.spacingX * grid.spacingZ;
    shell.stressBed       = NodeField(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j)
            if (3 * i + j > 2.7 * grid.cellsX) {
                shell.bending.rigidity(i, j) *= 3e-3;
                shell.stressBed(i, j) = 270 * shell.membraneCompliance(i, j) / (area * area);
            }
    return shell;
}

inline NodeField fingertip(const PlateGrid& grid, double x = 0, double z = 0)
{
    return footprintLoad(grid, 1, kSize / 2 + x, kSize / 2 + z, 4e-3);
}

} // namespace palp
