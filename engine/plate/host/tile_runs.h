#pragma once
#include "engine/plate/host/operator_rows.h"

namespace palp::PALPATE_ISA {

/// Calls visit(first row, last row, columns) for listed tiles; those that are neighbours along z come together.
template <class Visit>
void forEachTileRun(const PlateLevel& g, const uint* tiles, uint count, Visit&& visit)
{
    for (uint n = 0; n < count;) {
        const int tile = int(tiles[n]), firstI = tile / tilesZ(g) * kTile, firstJ = tile % tilesZ(g) * kTile;
        int       lastJ = firstJ - 1;
        do lastJ += kTile;
        while (++n < count && tiles[n] == tiles[n - 1] + 1 && lastJ < g.cellsZ);
        visit(firstI, min(firstI + kTile - 1, g.cellsX), ColumnRange{firstJ, min(lastJ, g.cellsZ)});
    }
}

} // namespace palp::PALPATE_ISA
