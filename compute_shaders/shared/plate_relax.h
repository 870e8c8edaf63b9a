// plate_relax.h - one step of relaxation of one node, and the divisor that makes it converge (GLSL and C++).
//
// Include plate_operator.h first.

// Rows of A have 13 entries; a node shares its colour, the parity of i + j, with eight of its twelve neighbours. A half
// sweep takes those from before the half sweep, and then converges (the splitting is P-regular) for every rigidity if
// the divisor is at least (a + s)/2, s the sum of |entries| of the same colour, by Gershgorin. For constant rigidity
// that is a/1.25, where the divisor below is a/1.1; where the rigidity is rough it is the bound with a margin of 2 %.
real relaxationDivisor(real diagonal, real sameColour)
{
    return max(diagonal / real(1.1f), real(0.51f) * (diagonal + sameColour));
}

// The same divisor d serves Chebyshev's iteration, which takes all nodes at once. A is positive definite, so with u the
// part of w on one colour and v that on the other  w'Aw <= w'Aw + (u-v)'A(u-v) = 2 (u'Au + v'Av),  and within a colour
// u'Au <= u'du / 0.51 by Gershgorin: all eigenvalues of A relative to d are positive and at most 2/0.51.
real relaxed(real before, real load, real forceOfBefore, real inverse)
{
    return before + (load - forceOfBefore) * inverse;
}

// One step of Chebyshev's iteration: `ahead` of the way that the last step took, and `step` along the residual.
real smoothed(real before, real beforeThat, real load, real forceOfBefore, real inverse, real ahead, real step)
{
    return (before + ahead * (before - beforeThat)) + step * ((load - forceOfBefore) * inverse);
}
