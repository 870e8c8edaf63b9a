// coarse_factor.glsl - Cholesky factor of the coarsest level's band, A = L L', by one workgroup: unknown after unknown,
// the columns within reach updated side by side.
//
// The includer declares  band  and  factor,  buffers of real: columns of the lower triangle of A, and those of L with
// the inverse of the diagonal in its place, 0 where rounding has left no pivot. Include coarse_band.h first. A
// workgroup has a power of two of invocations.

#ifdef PALPATE_DOUBLE
const real kLeast = real(kLeastPivotDouble), kDoubtful = kLeast;
#else
const real kLeast = kLeastPivot, kDoubtful = kDoubtfulPivot;
#endif

// Columns within reach, updated so far, and those that are next: column n is at n mod the ring's length.
const int kAhead = 16; // columns that are read from memory together
shared real window[kMostHalfBand + 1 + kAhead][kMostHalfBand + 1];
shared real diagonal[kMostHalfBand + 1 + kAhead]; // of A

// Reads columns from the first one on into the window.
void bringColumns(int first, int count, int slots, int unknowns)
{
    int ring = slots + kAhead;
    for (int n = int(gl_LocalInvocationID.x); n < count * slots; n += int(gl_WorkGroupSize.x)) {
        int  column = first + n / slots, d = n % slots, slot = column % ring;
        real entry  = column < unknowns ? band[column * slots + d] : real(0.0f);
        window[slot][d] = entry;
        if (d == 0) diagonal[slot] = entry;
    }
}

shared real inverses[2]; // of the diagonal of L, of this column and the next one

// Finds the inverse of a column's diagonal, once no other column changes its pivot; counts what is lost.
void invertPivot(int slot, int column, inout uint lost)
{
    real pivot = window[slot][0], all = diagonal[slot];
    inverses[column & 1] = !(pivot > kLeast * all) ? real(0.0f) : inverseRoot(pivot);
    if (!(pivot > kDoubtful * all)) ++lost;
}

// Returns to invocation 0 the number of pivots that rounding has left nothing of, or nothing that can be relied on.
uint factorBand(PlateLevel g)
{
    int reach = halfBand(g), slots = reach + 1, ring = slots + kAhead;
    int unknowns = nodesX(g) * nodesZ(g);
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    int beside = max(1, lanes / 32); // invocations that share a column
    bringColumns(0, slots, slots, unknowns);
    barrier();
    uint lost = 0u;
    if (lane == 0) invertPivot(0, 0, lost);
    int slot = 0;
    for (int n = 0; n < unknowns; ++n) {
        barrier();
        if (n % kAhead == 0) bringColumns(n + slots, kAhead, slots, unknowns); // in reach from the next column on
        real inverse = inverses[n & 1];
        for (int d = lane; d <= reach; d += lanes)
            factor[n * slots + d] = d == 0 ? inverse : window[slot][d] * inverse;
        for (int d = 1 + lane / beside; d <= reach; d += lanes / beside) { // of column n + d
            int other = slot + d < ring ? slot + d : slot + d - ring;
            real across = window[slot][d] * inverse;
            for (int e = d + lane % beside; e <= reach; e += beside) { // this invocation's alone
                window[other][e - d] -= across * (window[slot][e] * inverse);
                // The first of all, of invocation 0: the next pivot's root is found while the others go on.
                if (e == 1 && n + 1 < unknowns) invertPivot(other, n + 1, lost);
            }
        }
        slot = slot + 1 < ring ? slot + 1 : 0;
    }
    return lost;
}
