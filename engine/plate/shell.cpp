#include "engine/plate/shell.h"

#include <algorithm>
#include <cmath>

namespace palp {
namespace {

bool isFinite(const NodeField& field)
{
    return std::ranges::all_of(field.values(), [](double value) { return std::isfinite(value); });
}

/// The moments of a bent sheet.
struct Moments {
    NodeField x, z; ///< Mx, Mz at the nodes [N]
    NodeField xz;   ///< twisting moment of the cell whose first corner is the node [N]

    Moments(const Plate& plate, const NodeField& w) : x(plate.grid), z(plate.grid), xz(plate.grid)
    {
        const PlateGrid& g  = plate.grid;
        const double     nu = plate.poissonRatio, hx = g.spacingX, hz = g.spacingZ;
        const NodeField& D = plate.rigidity;
        for (int i = 0; i < g.cellsX; ++i)
            for (int j = 0; j < g.cellsZ; ++j) {
                const double mean = (D(i, j) + D(i + 1, j) + D(i, j + 1) + D(i + 1, j + 1)) / 4;
                xz(i, j) = mean * (1 - nu) * (w(i, j) - w(i + 1, j) - w(i, j + 1) + w(i + 1, j + 1)) / (hx * hz);
                if (i == 0 || j == 0) continue; // moments on the rim are not known here
                const double xx = (w(i - 1, j) - 2 * w(i, j) + w(i + 1, j)) / (hx * hx);
                const double zz = (w(i, j - 1) - 2 * w(i, j) + w(i, j + 1)) / (hz * hz);
                x(i, j)         = D(i, j) * (xx + nu * zz);
                z(i, j)         = D(i, j) * (zz + nu * xx);
            }
    }
};

} // namespace

double shearWork(const Shell& shell, const NodeField& w)
{
    constexpr double kShare = 5.0 / 6; // of the thickness that bears shear evenly: Reissner's [1]
    const PlateGrid& g      = shell.bending.grid;
    const Moments    m(shell.bending, w);
    const NodeField& C      = shell.membraneCompliance;
    const auto       counts = [&](int i, int j) { return shell.sheared.values().empty() ? 1 : shell.sheared(i, j); };
    double           work   = 0;
    // Halfway between two inner nodes both terms of a component of div M lie at the same place. 1/(G h) is 2 (1 + nu) C.
    for (int i = 1; i + 1 < g.cellsX; ++i)
        for (int j = 1; j < g.cellsZ; ++j) {
            const double q = (m.x(i + 1, j) - m.x(i, j)) / g.spacingX + (m.xz(i, j) - m.xz(i, j - 1)) / g.spacingZ;
            work += q * q * (counts(i, j) * C(i, j) + counts(i + 1, j) * C(i + 1, j)) / 2;
        }
    for (int i = 1; i < g.cellsX; ++i)
        for (int j = 1; j + 1 < g.cellsZ; ++j) {
            const double q = (m.z(i, j + 1) - m.z(i, j)) / g.spacingZ + (m.xz(i, j) - m.xz(i - 1, j)) / g.spacingX;
            work += q * q * (counts(i, j) * C(i, j) + counts(i, j + 1) * C(i, j + 1)) / 2;
        }
    return work * 2 * (1 + shell.bending.poissonRatio) / kShare * g.spacingX * g.spacingZ;
}

Plate membraneOf(const Shell& shell)
{
    Plate membrane;
    membrane.grid         = shell.bending.grid;
    membrane.edges        = shell.stressEdges;
    membrane.poissonRatio = -shell.bending.poissonRatio;
    membrane.rigidity     = shell.membraneCompliance;
    return membrane;
}

bool isStressFree(const Shell& shell) noexcept
{
    return shell.stressEdges == PlateEdges{Edge::free, Edge::free, Edge::free, Edge::free};
}

std::optional<std::string> whyUnsolvable(const Shell& shell)
{
    if (auto why = whyUnsolvable(shell.bending)) return why;
    const PlateGrid& grid = shell.bending.grid;
    if (!shell.membraneCompliance.on(grid)) return "the membrane's compliance is on another grid than the rigidity";
    if (!std::ranges::all_of(shell.membraneCompliance.values(), [](double c) { return c > 0 && std::isfinite(c); }))
        return "the membrane's compliance has to be positive and finite everywhere";
    for (const NodeField* curvature : {&shell.curvatureX, &shell.curvatureZ, &shell.curvatureXZ}) {
        if (!curvature->on(grid)) return "a curvature is on another grid than the rigidity";
        if (!isFinite(*curvature)) return "a curvature is not finite";
    }
    if (shell.bending.poissonRatio < 0) return "a shell's Poisson's ratio has to be at least 0";
    if (isStressFree(shell)) return std::nullopt;
    if (const auto why = whyUnsolvable(membraneOf(shell)))
        return "the edges of the membrane: " + *why + " (let all four be free or hold two neighbouring sides)";
    return std::nullopt;
}

} // namespace palp
