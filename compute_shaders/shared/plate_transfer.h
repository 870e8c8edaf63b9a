// plate_transfer.h - cubic interpolation between two levels, and its transpose (GLSL and C++).
//
// One axis at a time, by tables that the host makes once per pair of levels
// (engine/plate/multigrid/detail/transfer_table.h): they handle the ghosts beyond each kind of side, and sizes that do
// not divide by two. A fourth-order equation needs transfers
// whose orders sum to more than four: bilinear interpolation makes the cycle diverge. Restriction is exactly the
// transpose, because residuals are forces; a symmetric cycle can then precondition conjugate gradients. Include
// transfer_layout.h first.
//
// The inner sums are those that can be shared: of a coarse row of nodes with all fine rows that it gives to, of a
// coarse row with all fine rows that it takes from. A weight of 0 may be omitted, as deflections and forces are finite.
//
// The includer provides  float tableX(int n), float tableZ(int n)  and  real coarseValue(int i, int j)  or
// float fineValue(int i, int j).

#ifdef PALPATE_PROLONGS
real prolongedAt(int i, int j)
{
    int  atX = kFineStride * i, atZ = kFineStride * j;
    int  firstX = int(tableX(atX)), firstZ = int(tableZ(atZ));
    real sum = real(0);
    for (int m = 0; m < kFineWeights; ++m) {
        real row = real(0);
        for (int n = 0; n < kFineWeights; ++n) row += real(tableZ(atZ + 1 + n)) * coarseValue(firstX + m, firstZ + n);
        sum += real(tableX(atX + 1 + m)) * row;
    }
    return sum;
}
#endif

#ifdef PALPATE_RESTRICTS
float restrictedAt(int i, int j, int fineNodesX, int fineNodesZ)
{
    int   atX = kFineStride * fineNodesX + kCoarseStride * i, atZ = kFineStride * fineNodesZ + kCoarseStride * j;
    int   firstX = int(tableX(atX)), firstZ = int(tableZ(atZ));
    float sum = 0.0f;
    for (int n = 0; n < kCoarseWeights; ++n) {
        float column = 0.0f;
        for (int m = 0; m < kCoarseWeights; ++m)
            column += tableX(atX + 1 + m) * fineValue(min(firstX + m, fineNodesX - 1), min(firstZ + n, fineNodesZ - 1));
        sum += tableZ(atZ + 1 + n) * column;
    }
    return sum;
}
#endif
