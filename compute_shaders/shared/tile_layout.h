// tile_layout.h - the tiles of a level, numbered along z first (GLSL and C++).
#ifndef PALPATE_TILE_LAYOUT_H
#define PALPATE_TILE_LAYOUT_H

#include "compute_shaders/shared/plate_level.h"

#ifdef __cplusplus
namespace palp::shared {
#endif

const float kJump = 3.0f; // a rigidity that varies by more within 3 x 3 nodes jumps [1]

const int kTile = 8; // nodes along either side: a workgroup of plate_relax_tile.comp

// Every processor takes this many workgroups along x; tiles beyond get no extra sweeps: that costs steps, not accuracy.
const uint kMostListed = 65535u;

PALPATE_INLINE int tilesX(PlateLevel g)
{
    return g.cellsX / kTile + 1;
}
PALPATE_INLINE int tilesZ(PlateLevel g)
{
    return g.cellsZ / kTile + 1;
}

#ifdef __cplusplus
} // namespace palp::shared
#endif
#endif
