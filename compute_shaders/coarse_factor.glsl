// coarse_factor.glsl - Cholesky factor of the coarsest level's band, A = L L', by one workgroup: unknown after unknown, the
// columns within reach updated side by side.
//
// The includer declares  band  and  factor,  buffers of real: columns of the lower triangle of A, and those of L with the
// inverse of the diagonal in its place, 0 where rounding has left no pivot. Include coarse_band.h first.

#ifdef PALPATE_DOUBLE
const real kLeast = real(kLeastPivotDouble), kDoubtful = kLeast;
#else
const real kLeast = kLeastPivot, kDoubtful = kDoubtfulPivot;
#endif

shared real window[kMostHalfBand + 1][kMostHalfBand + 1]; // column n, updated so far, at n mod (halfBand + 1)
shared real column[kMostHalfBand + 1];                    // of L

// Returns the number of pivots that rounding has left nothing of, or nothing that can be relied on.
uint factorBand(PlateLevel g)
{
    int reach = halfBand(g), slots = reach + 1;
    int unknowns = nodesX(g) * nodesZ(g);
    int lane = int(gl_LocalInvocationID.x), lanes = int(gl_WorkGroupSize.x);
    for (int n = lane; n < slots * slots; n += lanes) window[n / slots][n % slots] = n / slots < unknowns ? band[n] : real(0.0f);
    uint lost = 0u;
    for (int n = 0; n < unknowns; ++n) {
        int slot = n % slots;
        barrier();
        real pivot = window[slot][0];
        bool holds = !(pivot > kLeast * band[n * slots]);
        real inverse = holds ? real(0.0f) : real(1.0f) / sqrt(pivot);
        if (!(pivot > kDoubtful * band[n * slots])) ++lost;
        for (int d = lane; d <= reach; d += lanes) {
            column[d] = window[slot][d] * inverse;
            factor[n * slots + d] = d == 0 ? inverse : column[d];
        }
        barrier();
        for (int d = 1 + lane; d <= reach; d += lanes) { // of column n + d; this invocation's alone
            int other = (n + d) % slots;
            for (int e = d; e <= reach; ++e) window[other][e - d] -= column[d] * column[e];
        }
        // The slot of column n is free: the column that comes into reach next.
        int next = n + slots;
        for (int d = lane; d <= reach; d += lanes) window[slot][d] = next < unknowns ? band[next * slots + d] : real(0.0f);
    }
    return lost;
}
