#include "engine/plate/multigrid/detail/grid_hierarchy.h"

#include <string>

#include "engine/core/contract.h"
#include "engine/plate/multigrid/detail/transfer_table.h"

namespace palp {
namespace {

shared::uint sides(const PlateEdges& edges, bool (*chosen)(Edge))
{
    return (chosen(edges.x0) ? shared::kSideX0 : 0) | (chosen(edges.x1) ? shared::kSideX1 : 0) |
           (chosen(edges.z0) ? shared::kSideZ0 : 0) | (chosen(edges.z1) ? shared::kSideZ1 : 0);
}

/// \param bed  foundation k hx^2 hz^2 / D0 of the finest grid [1]
shared::PlateLevel levelOf(const PlateGrid& grid, const Plate& plate, double bed)
{
    const double area  = grid.spacingX * grid.spacingZ / (plate.grid.spacingX * plate.grid.spacingZ);
    const double ratio = grid.spacingZ * grid.spacingZ / (grid.spacingX * grid.spacingX);
    const double nu    = plate.poissonRatio;
    const double along = (1 - nu * nu) / 2;

    shared::PlateLevel level{};
    level.cellsX  = grid.cellsX;
    level.cellsZ  = grid.cellsZ;
    level.hinged  = sides(plate.edges, [](Edge edge) { return !holdsSlope(edge); });
    level.free    = sides(plate.edges, [](Edge edge) { return !holdsNodes(edge); });
    level.kxx     = float(ratio / area);
    level.kzz     = float(1 / ratio / area);
    level.kxz     = float(nu / area);
    level.exx     = float(along * ratio / area);
    level.ezz     = float(along / ratio / area);
    level.twist   = float((1 - nu) / 2 / area);
    level.bed     = float(bed * area);
    level.shapeAt = plate.foundationShape.values().empty() ? 0 : int(grid.nodes());
    return level;
}

constexpr int kFewestCells = 8; ///< an axis with fewer is not halved: interpolation needs four coarse nodes

PlateGrid coarser(const PlateGrid& grid, int coarsest)
{
    constexpr double kUneven = 1.5; // ratio of spacings [1]
    const bool       mayX = grid.cellsX >= kFewestCells, mayZ = grid.cellsZ >= kFewestCells;
    bool             x = mayX && grid.spacingX < kUneven * grid.spacingZ;
    bool             z = mayZ && grid.spacingZ < kUneven * grid.spacingX;
    if (!x && !z) { // the axis that should be halved first cannot be
        x = mayX && grid.cellsX > coarsest;
        z = mayZ && grid.cellsZ > coarsest;
    }
    PlateGrid result = grid;
    if (x) result.cellsX = (grid.cellsX + 1) / 2;
    if (z) result.cellsZ = (grid.cellsZ + 1) / 2;
    result.spacingX = grid.sizeX() / result.cellsX;
    result.spacingZ = grid.sizeZ() / result.cellsZ;
    return result;
}

} // namespace

GridHierarchy gridHierarchy(const Plate& plate, double unitRigidity, int coarsest)
{
    PALP_EXPECT(coarsest >= kFewestCells && coarsest <= shared::kMostCoarseCells, std::to_string(coarsest) + " cells");
    PALP_EXPECT(unitRigidity > 0, std::to_string(unitRigidity) + " N m");
    const double hx = plate.grid.spacingX, hz = plate.grid.spacingZ;
    const double bed = plate.foundation * hx * hx * hz * hz / unitRigidity;

    GridHierarchy result;
    result.stiffness = unitRigidity / (hx * hz);
    for (PlateGrid grid = plate.grid;;) {
        result.levels.push_back({levelOf(grid, plate, bed), {}, {}});
        if (grid.cellsX <= coarsest && grid.cellsZ <= coarsest) return result;
        const PlateGrid next        = coarser(grid, coarsest);
        result.levels.back().tableX = transferTable(grid.cellsX, next.cellsX, plate.edges.x0, plate.edges.x1);
        result.levels.back().tableZ = transferTable(grid.cellsZ, next.cellsZ, plate.edges.z0, plate.edges.z1);
        grid                        = next;
    }
}

} // namespace palp
