// shell_coupling.h - how deflection and Airy's function of a curved shell pull at each other (GLSL and C++).
//
//   - int w (kx phi_zz + kz phi_xx - 2 kxz phi_xz)
//
// is summed over nodes, each with its share of a cell's area, and for the twist over cells, as the energies of the two
// fields are. Deflection w and phi both lie under the plate's operator (plate_operator.h), phi with the membrane's
// compliance in place of the rigidity and -nu in place of nu; this header has what stands between them.
//
// The entries of a row have to add up to nothing exactly, or a shell that moves as a whole would be strained: they are
// summed in the precision of the row, however the curvatures were rounded.
//
// Undivided differences need no number of the level but the ratio of its spacings: coarser levels use the same values.
//
// The includer provides, for nodes of the grid,  float curvatureX(int i, int j),  curvatureZ  and  curvatureXZ.
// Include plate_grid.h first.
//
// Source   Marguerre 1938, linear part

// Factor of the n-th node's neighbour in the second difference there; a hinged side has none, beyond a clamped one lies
// the mirror image.
real secondDifferenceEntry(int n, int step, int cells, bool hingedFirst, bool hingedLast)
{
    bool first = n == 0, last = n == cells;
    if ((first && hingedFirst) || (last && hingedLast)) return real(0.0f);
    if (step == 0) return real(-2.0f);
    if (!first && !last) return real(1.0f);
    return (step > 0) == first ? real(2.0f) : real(0.0f);
}

// The twist of a cell's four nodes, times the mean curvature there; 0 outside.
real cellTwist(PlateLevel g, int i, int j)
{
    if (i < 0 || j < 0 || i >= g.cellsX || j >= g.cellsZ) return real(0.0f);
    return real(0.25f) * ((real(curvatureXZ(i, j)) + real(curvatureXZ(i + 1, j))) +
                          (real(curvatureXZ(i, j + 1)) + real(curvatureXZ(i + 1, j + 1))));
}

// Entry of the row of w(i, j) for phi(i + di, j + dj), di and dj from -1 to 1; `stress` is the level of phi.
real couplingEntry(PlateLevel stress, int i, int j, int di, int dj)
{
    real shareX = i == 0 || i == stress.cellsX ? real(0.5f) : real(1.0f),
         shareZ = j == 0 || j == stress.cellsZ ? real(0.5f) : real(1.0f);
    real ratio  = sqrt(real(stress.kxx) / real(stress.kzz)); // hz^2 / hx^2
    real slim   = sqrt(ratio);                               // hz / hx
    real entry  = real(0.0f);
    if (dj == 0)
        entry -= real(curvatureZ(i, j)) * shareX * shareZ * slim *
                 secondDifferenceEntry(i, di, stress.cellsX, (stress.hinged & kSideX0) != 0u,
                                       (stress.hinged & kSideX1) != 0u);
    if (di == 0)
        entry -= real(curvatureX(i, j)) * shareX * shareZ / slim *
                 secondDifferenceEntry(j, dj, stress.cellsZ, (stress.hinged & kSideZ0) != 0u,
                                       (stress.hinged & kSideZ1) != 0u);
    for (int m = -1; m <= 0; ++m)
        for (int n = -1; n <= 0; ++n) { // the cells around (i, j) that hold (i + di, j + dj)
            int u = di - m, v = dj - n;
            if (u < 0 || u > 1 || v < 0 || v > 1) continue;
            real sign = u == v ? real(1.0f) : real(-1.0f);
            entry += real(0.5f) * sign * cellTwist(stress, i + m, j + n);
        }
    return entry;
}
