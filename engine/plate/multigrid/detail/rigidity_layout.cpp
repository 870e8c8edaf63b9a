#include "engine/plate/multigrid/detail/rigidity_layout.h"

#include "compute_shaders/shared/tile_layout.h"

namespace palp {
namespace {

/// Every processor takes a part of a buffer that begins at a multiple of 256 bytes.
constexpr std::size_t kPart = 64; // numbers

std::size_t inParts(std::size_t numbers)
{
    return (numbers + kPart - 1) / kPart * kPart;
}

} // namespace

RigidityLayout rigidityLayout(const GridHierarchy& grids)
{
    RigidityLayout all;
    for (const GridHierarchy::Level& level : grids.levels) {
        const shared::PlateLevel& g      = level.plate;
        const int                 tilesX = shared::tilesX(g), tilesZ = shared::tilesZ(g);
        all.levels.push_back({g, int(all.numbers), int(all.words), int(all.rows), int(all.tileRows)});
        all.numbers += inParts(nodesOf(g) * (g.shapeAt == 0 ? 1 : 2));
        all.words += inParts(1 + std::size_t(tilesX) * std::size_t(tilesZ));
        if (all.levels.size() == grids.levels.size()) break;
        all.rows += std::uint32_t(g.cellsX + 1);
        all.tileRows += std::uint32_t(tilesX);
    }
    return all;
}

} // namespace palp
