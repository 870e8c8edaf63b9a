#include "engine/plate/shell.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/core/extremes.h"

namespace palp {
namespace {

bool isFinite(const NodeField& field)
{
    return std::ranges::all_of(field.values(), [](double value) { return std::isfinite(value); });
}

/// The moments of a row of nodes, and those of twisting of the cells ahead.
struct RowOfMoments {
    std::vector<double> x, z, xz; ///< [N]

    explicit RowOfMoments(int nodes) : x(std::size_t(nodes)), z(std::size_t(nodes)), xz(std::size_t(nodes)) {}

    /// \param i  from 0 to the last row of cells; moments on the rim are not known here
    void fill(const Plate& plate, const NodeField& w, int i)
    {
        const PlateGrid& g  = plate.grid;
        const double     nu = plate.poissonRatio, hx = g.spacingX, hz = g.spacingZ;
        const double     perXX = 1 / (hx * hx), perZZ = 1 / (hz * hz), perXZ = (1 - nu) / (4 * hx * hz);
        const int        n = g.nodesZ();
        const double *   d = &plate.rigidity(i, 0), *at = &w(i, 0), *dAhead = d + n, *ahead = at + n;
        for (int j = 0; j + 1 < n; ++j)
            xz[std::size_t(j)] =
                perXZ * (d[j] + d[j + 1] + dAhead[j] + dAhead[j + 1]) * (at[j] - ahead[j] - at[j + 1] + ahead[j + 1]);
        if (i == 0) return;
        const double* behind = at - n;
        for (int j = 1; j + 1 < n; ++j) {
            const double xx   = perXX * (behind[j] - 2 * at[j] + ahead[j]),
                         zz   = perZZ * (at[j - 1] - 2 * at[j] + at[j + 1]);
            x[std::size_t(j)] = d[j] * (xx + nu * zz);
            z[std::size_t(j)] = d[j] * (zz + nu * xx);
        }
    }
};

/// Returns how steep a field is at an inner node: along either axis the root of the mean square of its slopes to both
/// sides, which a jump to one of them enters and a smooth map to the second order [1/m].
double steepnessAt(const NodeField& field, const PlateGrid& g, int i, int j)
{
    const double own  = field(i, j);
    const double east = field(i + 1, j) - own, west = field(i - 1, j) - own;
    const double north = field(i, j + 1) - own, south = field(i, j - 1) - own;
    return std::sqrt((east * east + west * west) / (2 * g.spacingX * g.spacingX) +
                     (north * north + south * south) / (2 * g.spacingZ * g.spacingZ));
}

/// Returns what counts between two nodes: their shares bear the same force side by side.
double between(double a, double b)
{
    return a > 0 && b > 0 ? 2 * a * b / (a + b) : 0;
}

} // namespace

Shear::Shear(const Shell& shell) : plate_(shell.bending), alongX_(shell.bending.grid), alongZ_(shell.bending.grid)
{
    constexpr double kShare  = 5.0 / 6; // of the thickness that bears shear evenly: Reissner's [1]
    constexpr double kSpread = 0.55;    // 4 / sqrt(10) over the logarithm of a contrast of 10, see the class [1]
    const PlateGrid& g       = plate_.grid;
    // 1/(G h) is 2 (1 + nu) C.
    const double unit = 2 * (1 + plate_.poissonRatio) / kShare * g.spacingX * g.spacingZ;
    NodeField    gives(g), logarithm(g);
    for (std::size_t n = 0; n < logarithm.values().size(); ++n)
        logarithm.values()[n] = std::log(plate_.rigidity.values()[n]);
    for (int i = 1; i < g.cellsX; ++i)
        for (int j = 1; j < g.cellsZ; ++j) {
            const double counts = shell.sheared.values().empty() ? 1 : shell.sheared(i, j);
            const double C      = shell.membraneCompliance(i, j);
            const double h =
                std::sqrt(12 * (1 - plate_.poissonRatio * plate_.poissonRatio) * plate_.rigidity(i, j) * C);
            const double steep = kSpread * h * steepnessAt(logarithm, g, i, j);
            gives(i, j)        = unit * counts * C / (1 + steep);
        }
    for (int i = 1; i < g.cellsX; ++i)
        for (int j = 1; j < g.cellsZ; ++j) {
            if (i + 1 < g.cellsX) alongX_(i, j) = between(gives(i, j), gives(i + 1, j));
            if (j + 1 < g.cellsZ) alongZ_(i, j) = between(gives(i, j), gives(i, j + 1));
        }
}

double Shear::workOf(const NodeField& w) const
{
    const PlateGrid& g    = plate_.grid;
    const double     perX = 1 / g.spacingX, perZ = 1 / g.spacingZ;
    const auto       last = std::size_t(g.cellsZ); // inner nodes come before it
    RowOfMoments     behind(g.nodesZ()), row(g.nodesZ()), ahead(g.nodesZ());
    row.fill(plate_, w, 0);
    ahead.fill(plate_, w, 1);
    double work = 0;
    // Halfway between two inner nodes both terms of a component of div M lie at the same place.
    for (int i = 1; i < g.cellsX; ++i) {
        std::swap(behind, row);
        std::swap(row, ahead);
        const double *givesX = &alongX_(i, 0), *givesZ = &alongZ_(i, 0);
        for (std::size_t j = 1; j + 1 < last; ++j) {
            const double q = perZ * (row.z[j + 1] - row.z[j]) + perX * (row.xz[j] - behind.xz[j]);
            work += q * q * givesZ[j];
        }
        if (i + 1 == g.cellsX) break;
        ahead.fill(plate_, w, i + 1);
        for (std::size_t j = 1; j < last; ++j) {
            const double q = perX * (ahead.x[j] - row.x[j]) + perZ * (row.xz[j] - row.xz[j - 1]);
            work += q * q * givesX[j];
        }
    }
    return work;
}

double squeezeWork(const Shell& shell, const NodeField& w, const Footprint& load)
{
    const Plate&     plate  = shell.bending;
    const PlateGrid& g      = plate.grid;
    const double     nu     = plate.poissonRatio;
    const auto       nodesZ = std::uint32_t(g.nodesZ());
    double           work   = 0;
    for (const Footprint::Part& part : load.parts) {
        const int i = int(part.node / nodesZ), j = int(part.node % nodesZ);
        if (i == 0 || j == 0 || i == g.cellsX || j == g.cellsZ) continue; // moments on the rim are not known here
        const double bends = (w(i - 1, j) - 2 * w(i, j) + w(i + 1, j)) / (g.spacingX * g.spacingX) +
                             (w(i, j - 1) - 2 * w(i, j) + w(i, j + 1)) / (g.spacingZ * g.spacingZ);
        const double counts = shell.sheared.values().empty() ? 1 : shell.sheared(i, j);
        work -= counts * part.force * shell.membraneCompliance(i, j) * plate.rigidity(i, j) * (1 + nu) * bends;
    }
    return 1.2 * nu * work;
}

double shearWork(const Shell& shell, const NodeField& w)
{
    return Shear(shell).workOf(w);
}

Plate membraneOf(const Shell& shell)
{
    Plate membrane;
    membrane.grid         = shell.bending.grid;
    membrane.edges        = shell.stressEdges;
    membrane.poissonRatio = -shell.bending.poissonRatio;
    membrane.rigidity     = shell.membraneCompliance;
    const double most     = shell.stressBed.values().empty() ? 0 : extremesOf(shell.stressBed.values()).most;
    if (!(most > 0)) return membrane;
    membrane.foundation      = most;
    membrane.foundationShape = shell.stressBed;
    for (double& share : membrane.foundationShape.values()) share /= most;
    return membrane;
}

NodeField sharesOfSheet(const Shell& shell)
{
    if (shell.stressBed.values().empty()) return {};
    NodeField shares = shell.bending.rigidity;
    double    most   = 0;
    for (std::size_t n = 0; n < shares.values().size(); ++n) {
        shares.values()[n] *= shell.membraneCompliance.values()[n];
        most = std::max(most, shares.values()[n]);
    }
    for (double& share : shares.values()) share /= most;
    return shares;
}

bool isStressFree(const Shell& shell) noexcept
{
    return shell.stressEdges == PlateEdges{Edge::free, Edge::free, Edge::free, Edge::free} &&
           std::ranges::all_of(shell.stressBed.values(), [](double k) { return k == 0; });
}

std::array<std::size_t, 3> pinsOfStress(const PlateGrid& grid) noexcept
{
    const auto alongZ = std::size_t(grid.cellsZ);
    return {0, alongZ, std::size_t(grid.cellsX) * (alongZ + 1)};
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
    if (!shell.stressBed.values().empty() && !shell.stressBed.on(grid))
        return "the bed of the stresses is on another grid than the rigidity";
    if (!std::ranges::all_of(shell.stressBed.values(), [](double k) { return k >= 0 && std::isfinite(k); }))
        return "the bed of the stresses has to be finite and at least 0 everywhere";
    for (const NodeField* share : {&shell.sheared, &shell.stretched})
        if (!share->values().empty() && !share->on(grid))
            return "what is sheared or stretched is on another grid than the rigidity";
    if (!shell.thrusts.empty() && !(membraneOf(shell).foundation > 0))
        return "there are thrusts, but no bed that they leave";
    for (const NodeField& thrust : shell.thrusts)
        if (!thrust.on(grid) || !isFinite(thrust))
            return "a thrust is not finite, or on another grid than the rigidity";
    if (shell.bending.poissonRatio < 0) return "a shell's Poisson's ratio has to be at least 0";
    if (isStressFree(shell)) return std::nullopt;
    if (whyUnsolvable(membraneOf(shell))) // only its edges are left as a reason
        return "its stresses are held on too few sides, beside those that are clamped or guided; clamp all four, or "
               "let two neighbouring ones be supported";
    return std::nullopt;
}

} // namespace palp
