// plate_grid.h - which nodes are held, and what lies beyond the sides (GLSL and C++).

bool isHeld(PlateLevel g, int i, int j)
{
    return (i == 0 && (g.free & kSideX0) == 0u) || (i == g.cellsX && (g.free & kSideX1) == 0u) ||
           (j == 0 && (g.free & kSideZ0) == 0u) || (j == g.cellsZ && (g.free & kSideZ1) == 0u);
}

// Returns the index of the node whose value a ghost has: itself inside, its mirror image outside.
int mirrored(int n, int cells)
{
    int inside = n < 0 ? -n : n;
    return inside > cells ? 2 * cells - inside : inside;
}
