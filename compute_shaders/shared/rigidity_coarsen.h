// rigidity_coarsen.h - rigidity of a coarser level (GLSL and C++).
//
// Geometric mean with weights 1/4, 1/2, 1/4 along each axis that is coarsened. Square roots of products, in place of
// exponentials of logarithms, are rounded alike on every device. Arithmetic means serve random rigidities as well but
// sharp inclusions much worse; harmonic means fail.
//
// The includer provides  float fineRigidity(int i, int j).

float meanOfThree(float before, float middle, float after)
{
    return sqrt(middle * sqrt(before * after));
}

// Fine index that lies on, or nearest to, a coarse one.
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

float coarseRigidityAt(PlateLevel fine, PlateLevel coarse, int i, int j)
{
    bool alongX = coarse.cellsX != fine.cellsX, alongZ = coarse.cellsZ != fine.cellsZ;
    int  fi = finePlace(i, fine.cellsX, coarse.cellsX), fj = finePlace(j, fine.cellsZ, coarse.cellsZ);
    if (!alongX) return meanAlongZ(fi, fj, fine.cellsZ, alongZ);
    return meanOfThree(meanAlongZ(mirrored(fi - 1, fine.cellsX), fj, fine.cellsZ, alongZ),
                       meanAlongZ(fi, fj, fine.cellsZ, alongZ),
                       meanAlongZ(mirrored(fi + 1, fine.cellsX), fj, fine.cellsZ, alongZ));
}
