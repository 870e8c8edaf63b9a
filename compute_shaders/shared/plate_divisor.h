// plate_divisor.h - divisor of the relaxation from the entries of the operator's row (GLSL and C++).
//
// The includer provides  int unitI, unitJ  and a deflection that is 1 there and 0 elsewhere; include plate_operator.h
// and plate_relax.h first.

// The m-th of the eight nodes that share the colour of their middle.
int sameColourI(int m) { return m < 4 ? (m < 2 ? 2 - 4 * m : 0) : (m < 6 ? -1 : 1); }
int sameColourJ(int m) { return m < 4 ? (m < 2 ? 0 : 10 - 4 * m) : ((m & 1) == 0 ? -1 : 1); }

// |entry| of the row of node (i, j) for the m-th of them, 0 if it is held or outside; m = 8: the diagonal.
float entryOf(PlateLevel g, int i, int j, int m)
{
    unitI       = m < 8 ? i + sameColourI(m) : i;
    unitJ       = m < 8 ? j + sameColourJ(m) : j;
    bool  moves = unitI >= 0 && unitI <= g.cellsX && unitJ >= 0 && unitJ <= g.cellsZ && !isHeld(g, unitI, unitJ);
    float entry = operatorAt(g, i, j);
    return m == 8 ? entry : moves ? abs(entry) : 0.0f;
}

#ifdef __cplusplus
// The sum of plate_divisor.comp.
float divisorAt(PlateLevel g, int i, int j)
{
    float others = 0.0f;
    for (int m = 0; m < 8; ++m) others += entryOf(g, i, j, m);
    return relaxationDivisor(entryOf(g, i, j, 8), others);
}
#endif
