#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/multigrid/detail/transfer_table.h"
#include "engine/plate/plate.h"

// Plates and fields that look random and are the same everywhere.

namespace palp {

/// Numbers in (-1, 1).
template <class Real>
std::vector<Real> roughValues(std::size_t count, std::uint32_t seed)
{
    std::mt19937      engine(seed); // its numbers are the standard's; those of distributions are not
    std::vector<Real> values(count);
    for (Real& value : values) {
        const double whole = double(engine() >> 8), part = double(engine() >> 8); // 24 bits each
        value = Real((whole + (sizeof(Real) == 8 ? part / 16777216 : 0)) / 8388608 - 1);
    }
    return values;
}

/// A plate of random rigidity in 0.5 .. 1.5 N m with a block in it that is a thousand times as stiff.
inline Plate roughPlate(int cellsX, int cellsZ, const PlateEdges& edges, double spacingX = 1, double spacingZ = 1)
{
    Plate plate;
    plate.grid         = {cellsX, cellsZ, spacingX, spacingZ};
    plate.edges        = edges;
    plate.poissonRatio = 0.3;
    plate.foundation   = 0.01;
    plate.rigidity     = NodeField(plate.grid);
    const auto values  = roughValues<double>(plate.grid.nodes(), std::uint32_t(cellsX * 1000 + cellsZ));
    for (int i = 0; i <= cellsX; ++i)
        for (int j = 0; j <= cellsZ; ++j) {
            const bool stiff     = 3 * i > cellsX && 3 * i < 2 * cellsX + 2 && 2 * j > cellsZ; // up to the side z = 1
            plate.rigidity(i, j) = (1 + 0.5 * values[std::size_t(i * (cellsZ + 1) + j)]) * (stiff ? 1000 : 1);
        }
    return plate;
}

/// The plate on a foundation that varies from 0 to 200 times its unit, and has a hole.
inline Plate onRoughBed(Plate plate)
{
    plate.foundationShape = NodeField(plate.grid);
    const auto values     = roughValues<double>(plate.grid.nodes(), std::uint32_t(plate.grid.nodes()));
    for (int i = 0; i <= plate.grid.cellsX; ++i)
        for (int j = 0; j <= plate.grid.cellsZ; ++j) {
            const bool hole             = 2 * i < plate.grid.cellsX && 2 * j < plate.grid.cellsZ;
            plate.foundationShape(i, j) = hole ? 0 : 100 * (1 + values[std::size_t(i * plate.grid.nodesZ() + j)]);
        }
    return plate;
}

inline std::string describe(const Plate& plate)
{
    return std::to_string(plate.grid.cellsX) + "x" + std::to_string(plate.grid.cellsZ) + " cells, x " +
           name(plate.edges.x0) + " to " + name(plate.edges.x1) + ", z " + name(plate.edges.z0) + " to " +
           name(plate.edges.z1) + (plate.foundationShape.values().empty() ? "" : ", on a rough bed");
}

/// The finest level of a plate and its rigidity as the shaders are given it, the largest being 1; behind it, if there
/// is one, the foundation's shape.
struct RoughLevel {
    shared::PlateLevel g;
    std::vector<float> rigidity;

    explicit RoughLevel(const Plate& plate)
    {
        const double most = *std::max_element(plate.rigidity.values().begin(), plate.rigidity.values().end());
        g                 = gridHierarchy(plate, most).levels.front().plate;
        for (const double D : plate.rigidity.values()) rigidity.push_back(float(D / most));
        for (const double s : plate.foundationShape.values()) rigidity.push_back(float(s));
    }
};

inline bool holds(const shared::PlateLevel& g, int i, int j)
{
    return (i == 0 && !(g.free & shared::kSideX0)) || (i == g.cellsX && !(g.free & shared::kSideX1)) ||
           (j == 0 && !(g.free & shared::kSideZ0)) || (j == g.cellsZ && !(g.free & shared::kSideZ1));
}

/// Deflections of some loads one after the other, 0 on held nodes.
template <class Real>
std::vector<Real> roughDeflection(const shared::PlateLevel& g, int loads, std::uint32_t seed)
{
    std::vector<Real> w = roughValues<Real>(nodesOf(g) * std::size_t(loads), seed);
    std::size_t       n = 0;
    for (int load = 0; load < loads; ++load)
        for (int i = 0; i <= g.cellsX; ++i)
            for (int j = 0; j <= g.cellsZ; ++j, ++n)
                if (holds(g, i, j)) w[n] = 0;
    return w;
}

/// A fine and a coarse grid over the same plate, with the tables between them.
struct LevelPair {
    shared::PlateLevel fine{}, coarse{};
    std::vector<float> tableX, tableZ;

    LevelPair(const shared::PlateLevel& fineLevel, const shared::PlateLevel& coarseLevel)
        : fine(fineLevel), coarse(coarseLevel)
    {
    }

    LevelPair(const Plate& plate, int coarseX, int coarseZ)
    {
        fine          = gridHierarchy(plate, 1).levels.front().plate;
        coarse        = fine; // transfers look at the sizes and the sides only
        coarse.cellsX = coarseX;
        coarse.cellsZ = coarseZ;
        if (fine.shapeAt != 0) coarse.shapeAt = int(nodesOf(coarse));
        tableX = transferTable(fine.cellsX, coarseX, plate.edges.x0, plate.edges.x1);
        tableZ = transferTable(fine.cellsZ, coarseZ, plate.edges.z0, plate.edges.z1);
    }
};

} // namespace palp
