#include "engine/pipeline/table_solve.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/plate/load.h"

namespace palp {
namespace {

/// Central difference of the load of a footprint that moves.
NodeField slopeOf(const NodeField& ahead, const NodeField& behind, double distance)
{
    NodeField slope = ahead;
    for (std::size_t n = 0; n < slope.values().size(); ++n)
        slope.values()[n] = (slope.values()[n] - behind.values()[n]) / distance;
    return slope;
}

/// ln c of a footprint, with its slopes.
ComplianceTable::Entry complianceOf(const FootprintLattice& lattice, std::size_t n, const NodeField& response)
{
    const double compliance = work(lattice.loads[n], response);
    return {std::log(compliance), 2 * work(lattice.slopesX[n], response) / compliance,
            2 * work(lattice.slopesZ[n], response) / compliance};
}

/// ln k_c of a footprint, with its slopes.  \param over  ln D over that of some node
ComplianceTable::Entry contactOf(const FootprintLattice& lattice, std::size_t n, const NodeField& over, double node)
{
    return {std::log(lattice.shape.contactPerRigidity * node) + work(lattice.loads[n], over),
            work(lattice.slopesX[n], over), work(lattice.slopesZ[n], over)};
}

} // namespace

double work(const NodeField& load, const NodeField& response)
{
    double sum = 0;
    for (std::size_t n = 0; n < load.values().size(); ++n) sum += load.values()[n] * response.values()[n];
    return sum;
}

FootprintLattice footprintLattice(const Plate& homogeneous, const FootprintTable& shape, PlateDevice& device,
                                  double tolerance)
{
    PALP_EXPECT(shape.side >= 1 && shape.side <= ComplianceTable::kMostSide && shape.side % 2 == 1,
                "a table of " + std::to_string(shape.side) + " entries a side");
    PALP_EXPECT(shape.contactPerRigidity > 0, "no contact stiffness");
    const PlateGrid& grid    = homogeneous.grid;
    const double     reach   = shape.side / 2 * shape.radius;
    const double     spacing = std::max(grid.spacingX, grid.spacingZ); // a slope is measured over one; see below
    const double     wanted = 2 * (reach + shape.radius) + spacing, found = std::min(grid.sizeX(), grid.sizeZ());
    if (found < wanted)
        throw Error("the window of " + formatQuantity(found, "m") + " does not hold a table of " +
                    std::to_string(shape.side) + " x " + std::to_string(shape.side) + " footprints of radius " +
                    formatQuantity(shape.radius, "m") + "; expected at least " + formatQuantity(wanted, "m"));

    FootprintLattice lattice{.shape = shape};
    const auto       loadAt = [&](double x, double z) {
        return footprintLoad(grid, 1, grid.sizeX() / 2 + x, grid.sizeZ() / 2 + z, shape.radius);
    };
    // Half a spacing to either side: the sub-cells of a footprint then cross as many nodes wherever it lies.
    const double dx = grid.spacingX / 2, dz = grid.spacingZ / 2;
    for (int i = 0; i < shape.side; ++i)
        for (int j = 0; j < shape.side; ++j) {
            const double x = (i - shape.side / 2) * shape.radius, z = (j - shape.side / 2) * shape.radius;
            lattice.loads.push_back(loadAt(x, z));
            lattice.slopesX.push_back(slopeOf(loadAt(x + dx, z), loadAt(x - dx, z), 2 * dx));
            lattice.slopesZ.push_back(slopeOf(loadAt(x, z + dz), loadAt(x, z - dz), 2 * dz));
        }
    const TableSolution own    = solveTable(homogeneous, lattice, device, tolerance);
    const double        middle = own.table.middle().lnCompliance;
    lattice.homogeneous        = own.table.compliance;
    for (ComplianceTable::Entry& entry : lattice.homogeneous) entry.value -= middle;
    return lattice;
}

TableSolution solveTable(const Plate& plate, const FootprintLattice& lattice, PlateDevice& device, double tolerance)
{
    std::vector<PlateSolution> solutions = device.solveAll(plate, lattice.loads, tolerance);
    TableSolution              result;
    result.table.side    = lattice.shape.side;
    result.table.spacing = lattice.shape.radius;

    const double node = plate.rigidity.values().front(); // logarithms are of ratios to it: exactly 0 if all are alike
    NodeField    over(plate.grid);
    for (std::size_t n = 0; n < over.values().size(); ++n)
        over.values()[n] = std::log(plate.rigidity.values()[n] / node);
    for (std::size_t n = 0; n < solutions.size(); ++n) {
        const ComplianceTable::Entry felt = complianceOf(lattice, n, solutions[n].deflection);
        const ComplianceTable::Entry own  = lattice.homogeneous[n];
        result.table.compliance[n]       = {felt.value - own.value, felt.slopeX - own.slopeX, felt.slopeZ - own.slopeZ};
        result.table.contactStiffness[n] = contactOf(lattice, n, over, node);
    }
    result.middle     = std::move(solutions[solutions.size() / 2]);
    result.compliance = work(lattice.loads[solutions.size() / 2], result.middle.deflection);
    return result;
}

} // namespace palp
