// shell_relax.h - one step of relaxation of both fields of a shell at a node (GLSL and C++).
//
// A node's deflection and Airy's function are relaxed together. Divisors dw and df are those of the plate for each
// field's own operator (plate_relax.h), and b couples the two at the node:
//
//     [ dw   b ] [ change of w   ]   [ residual of w   ]
//     [ b  -df ] [ change of phi ] = [ residual of phi ]
//
// The determinant - dw df - b^2 is never 0. Where the shell is curved so much that its length is below two spacings,
// relaxing the fields one after the other takes two to three times the steps.

// The inverse of that matrix; symmetric.
struct ShellInverse {
    real ww;
    real wf;
    real ff;
};

ShellInverse shellInverse(real dw, real df, real b, bool wMoves, bool fMoves)
{
    ShellInverse inverse;
    real         det = dw * df + b * b;
    inverse.ww       = wMoves ? (fMoves ? df / det : real(1.0f) / dw) : real(0.0f);
    inverse.wf       = wMoves && fMoves ? b / det : real(0.0f);
    inverse.ff       = fMoves ? (wMoves ? -dw / det : real(-1.0f) / df) : real(0.0f);
    return inverse;
}
