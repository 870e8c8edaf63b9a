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
// With g the share of a node in a cell's area times -kz hz/hx, and h the same of -kx hx/hz, the row of w at a node is
//
//     g dxx phi + h dzz phi + sum over its four cells of 1/2 cellTwist t,     t = phi00 - phi10 - phi01 + phi11
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

// The mean curvature kxz of a cell, from its four nodes.
real cellTwist(real k00, real k10, real k01, real k11)
{
    return real(0.25f) * ((k00 + k10) + (k01 + k11));
}
