#include "engine/plate/load.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace palp {
namespace {

/// Share of a plate's side by which rounding may put a point outside it [1]: far above the rounding of i * spacing and
/// far below any intended distance.
constexpr double kRounding = 1e-9;

/// A point's cell and its place in the cell, along one axis.
struct Place {
    int    cell;
    double fraction; ///< [1] 0 at node `cell`, 1 at the next
};

Place placeOf(double position, double spacing, int cells)
{
    const double steps = std::clamp(position / spacing, 0.0, double(cells));
    const int    cell  = std::min(int(steps), cells - 1);
    return {cell, steps - cell};
}

std::string pointText(double x, double z)
{
    std::ostringstream text;
    text << "(" << x << ", " << z << ") m";
    return text.str();
}

void addPointForce(NodeField& forces, const PlateGrid& grid, double force, double x, double z)
{
    const Place  px = placeOf(x, grid.spacingX, grid.cellsX);
    const Place  pz = placeOf(z, grid.spacingZ, grid.cellsZ);
    const double u = px.fraction, v = pz.fraction;
    forces(px.cell, pz.cell) += force * (1 - u) * (1 - v);
    forces(px.cell + 1, pz.cell) += force * u * (1 - v);
    forces(px.cell, pz.cell + 1) += force * (1 - u) * v;
    forces(px.cell + 1, pz.cell + 1) += force * u * v;
}

/// Integrates the normal density of mean `centre` and deviation `sigma` times each node's hat function.
///
/// With t = (x - centre)/sigma the density integrates to P = erf(t/sqrt 2)/2 and its first moment about the mean is
/// -sigma^2 times the density, so over one cell [a, b]
///     int (x - a)/(b - a) density = [ (centre - a)(P(b) - P(a)) - sigma^2 (density(b) - density(a)) ] / (b - a)
/// goes to node b, and the rest of P(b) - P(a) to node a.
std::vector<double> hatIntegrals(int cells, double spacing, double centre, double sigma)
{
    const auto cumulative = [&](double x) { return 0.5 * std::erf((x - centre) / (sigma * std::sqrt(2.0))); };
    const auto moment     = [&](double x) { // sigma^2 density(x) [m]
        const double t = (x - centre) / sigma;
        return sigma * std::exp(-0.5 * t * t) / std::sqrt(2 * std::numbers::pi);
    };
    std::vector<double> shares(std::size_t(cells) + 1, 0.0);
    for (int cell = 0; cell < cells; ++cell) {
        const double a = cell * spacing, b = (cell + 1) * spacing;
        const double total = cumulative(b) - cumulative(a);
        const double atB   = ((centre - a) * total - (moment(b) - moment(a))) / spacing;
        shares[std::size_t(cell)] += total - atB;
        shares[std::size_t(cell) + 1] += atB;
    }
    return shares;
}

} // namespace

bool isOnPlate(const PlateGrid& grid, double x, double z) noexcept
{
    const double slackX = kRounding * grid.sizeX(), slackZ = kRounding * grid.sizeZ();
    return x >= -slackX && x <= grid.sizeX() + slackX && z >= -slackZ && z <= grid.sizeZ() + slackZ;
}

double nodeArea(const PlateGrid& grid, int i, int j) noexcept
{
    const double alongX = (i == 0 || i == grid.cellsX ? 0.5 : 1.0) * grid.spacingX;
    const double alongZ = (j == 0 || j == grid.cellsZ ? 0.5 : 1.0) * grid.spacingZ;
    return alongX * alongZ;
}

NodeField uniformLoad(const PlateGrid& grid, double pressure)
{
    return gridLoad(grid, NodeField(grid, pressure));
}

NodeField gridLoad(const PlateGrid& grid, const NodeField& pressure)
{
    PALP_EXPECT(pressure.on(grid), "a pressure field of " + std::to_string(pressure.nodesX()) + " x " +
                                       std::to_string(pressure.nodesZ()) + " nodes");
    NodeField forces = pressure;
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) forces(i, j) *= nodeArea(grid, i, j);
    return forces;
}

NodeField pointLoad(const PlateGrid& grid, double force, double x, double z)
{
    PALP_EXPECT(isOnPlate(grid, x, z), "a force at " + pointText(x, z));
    NodeField forces(grid);
    addPointForce(forces, grid, force, x, z);
    return forces;
}

NodeField gaussianLoad(const PlateGrid& grid, double force, double x, double z, double sigma)
{
    PALP_EXPECT(std::isfinite(sigma) && sigma > 0, "a standard deviation of " + std::to_string(sigma) + " m");
    const std::vector<double> alongX = hatIntegrals(grid.cellsX, grid.spacingX, x, sigma);
    const std::vector<double> alongZ = hatIntegrals(grid.cellsZ, grid.spacingZ, z, sigma);
    NodeField                 forces(grid);
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) forces(i, j) = force * alongX[std::size_t(i)] * alongZ[std::size_t(j)];
    return forces;
}

NodeField footprintLoad(const PlateGrid& grid, double force, double x, double z, double radius)
{
    const double slackX = kRounding * grid.sizeX(), slackZ = kRounding * grid.sizeZ();
    const bool   inside = x - radius >= -slackX && x + radius <= grid.sizeX() + slackX && z - radius >= -slackZ &&
                        z + radius <= grid.sizeZ() + slackZ;
    if (!inside)
        throw Error("the footprint of radius " + std::to_string(radius) + " m at " + pointText(x, z) +
                    " does not lie wholly on the plate of " + std::to_string(grid.sizeX()) + " x " +
                    std::to_string(grid.sizeZ()) + " m; take a smaller --footprint-radius or a larger --window");
    const double spacing = std::max(grid.spacingX, grid.spacingZ);
    if (!(radius >= spacing * (1 - kRounding)))
        throw Error("the footprint of radius " + std::to_string(radius) + " m is smaller than one spacing of " +
                    std::to_string(spacing) +
                    " m; take more --cells, a --footprint-radius of that or more, or a smaller --window");

    // Sub-cells are laid out from the contact, not from the grid: their pattern then moves with the contact, so that
    // the load changes smoothly and a contact on a node gets a symmetric load.
    constexpr double kSubcellsPerSpacing = 4;  // chosen: a finer pattern moves no node's share by more than 1 %
    constexpr double kFewestPerRadius    = 16; // chosen: the same for a footprint of one spacing
    const int        halfCount = int(std::ceil(std::max(kFewestPerRadius, kSubcellsPerSpacing * radius / spacing)));
    const double     step      = 1.0 / halfCount; // sub-cell edge over radius [1]

    NodeField forces(grid);
    double    total = 0;
    for (int m = -halfCount; m < halfCount; ++m)
        for (int n = -halfCount; n < halfCount; ++n) {
            const double u = (m + 0.5) * step, v = (n + 0.5) * step; // place over radius [1]
            const double inRim = 1 - u * u - v * v;
            if (inRim <= 0) continue;
            addPointForce(forces, grid, inRim * inRim, x + u * radius, z + v * radius);
            total += inRim * inRim;
        }
    for (double& share : forces.values()) share *= force / total;
    return forces;
}

double dot(const NodeField& a, const NodeField& b)
{
    double sum = 0;
    for (std::size_t n = 0; n < a.values().size(); ++n) sum += a.values()[n] * b.values()[n];
    return sum;
}

double interpolate(const PlateGrid& grid, const NodeField& field, double x, double z)
{
    PALP_EXPECT(field.on(grid),
                "a field of " + std::to_string(field.nodesX()) + " x " + std::to_string(field.nodesZ()) + " nodes");
    PALP_EXPECT(isOnPlate(grid, x, z), "a value at " + pointText(x, z));
    const Place  px   = placeOf(x, grid.spacingX, grid.cellsX);
    const Place  pz   = placeOf(z, grid.spacingZ, grid.cellsZ);
    const double near = std::lerp(field(px.cell, pz.cell), field(px.cell, pz.cell + 1), pz.fraction);
    const double far  = std::lerp(field(px.cell + 1, pz.cell), field(px.cell + 1, pz.cell + 1), pz.fraction);
    return std::lerp(near, far, px.fraction);
}

} // namespace palp
