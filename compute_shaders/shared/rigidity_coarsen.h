// rigidity_coarsen.h - rigidity and foundation of a coarser level (GLSL and C++).
//
// Rigidity: geometric mean with weights 1/4, 1/2, 1/4 along each axis that is coarsened. Square roots of products, in
// place of exponentials of logarithms, are rounded alike on every processor. Arithmetic means are as good for random
// rigidities but much worse for sharp inclusions; harmonic means fail.
// Foundation: arithmetic mean with the same weights, since springs side by side add up, and a part may have none.
//
// The includer provides  float fineRigidity(int i, int j)  and  float fineShape(int i, int j).

float meanOfThree(float before, float middle, float after)
{
    return sqrt(middle * sqrt(before * after));
}

// Returns the fine index that lies on, or nearest to, a coarse one.
int finePlace(int coarse, int fineCells, int coarseCells)
{
    return (2 * coarse * fineCells + coarseCells) / (2 * coarseCells);
}

float meanAlongZ(int i, int j, int fineCellsZ, bool coarsened)
{
    if (!coarsened) return fineRigidity(i, j);
    return meanOfThree(fineRigidity(i, mirrored(j - 1, fineCellsZ)), fineRigidity(i, j),
                       fineRigidity(i, mirrored(j + 1, fineCellsZ)));
}

float coarseRigidityAt(PlateLevel from, PlateLevel to, int i, int j)
{
    bool alongX = to.cellsX != from.cellsX, alongZ = to.cellsZ != from.cellsZ;
    int  fi = finePlace(i, from.cellsX, to.cellsX), fj = finePlace(j, from.cellsZ, to.cellsZ);
    if (!alongX) return meanAlongZ(fi, fj, from.cellsZ, alongZ);
    return meanOfThree(meanAlongZ(mirrored(fi - 1, from.cellsX), fj, from.cellsZ, alongZ),
                       meanAlongZ(fi, fj, from.cellsZ, alongZ),
                       meanAlongZ(mirrored(fi + 1, from.cellsX), fj, from.cellsZ, alongZ));
}

float averageOfThree(float before, float middle, float after)
{
    return 0.5f * middle + 0.25f * (before + after);
}

float averageAlongZ(int i, int j, int fineCellsZ, bool coarsened)
{
    if (!coarsened) return fineShape(i, j);
    return averageOfThree(fineShape(i, mirrored(j - 1, fineCellsZ)), fineShape(i, j),
                          fineShape(i, mirrored(j + 1, fineCellsZ)));
}

// The foundation's shape at a coarse node.
float coarseShapeAt(PlateLevel from, PlateLevel to, int i, int j)
{
    bool alongX = to.cellsX != from.cellsX, alongZ = to.cellsZ != from.cellsZ;
    int  fi = finePlace(i, from.cellsX, to.cellsX), fj = finePlace(j, from.cellsZ, to.cellsZ);
    if (!alongX) return averageAlongZ(fi, fj, from.cellsZ, alongZ);
    return averageOfThree(averageAlongZ(mirrored(fi - 1, from.cellsX), fj, from.cellsZ, alongZ),
                          averageAlongZ(fi, fj, from.cellsZ, alongZ),
                          averageAlongZ(mirrored(fi + 1, from.cellsX), fj, from.cellsZ, alongZ));
}
