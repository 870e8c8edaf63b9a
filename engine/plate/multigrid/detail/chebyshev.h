#pragma once
#include <vector>

namespace palp {

/// One step of Chebyshev's iteration: w after = w + ahead (w - w before it) + step (residual of w) / divisor.
struct ChebyshevStep {
    float ahead; ///< [1] 0 in the first step
    float step;  ///< [1]
};

/// Returns the steps of Chebyshev's iteration for a symmetric matrix.
///
/// For eigenvalues, relative to the divisor, from `smallest` to `largest`, at most 1/T((largest + smallest)/(largest -
/// smallest)) of an error along an eigenvector remains, T being Chebyshev's polynomial of degree `count`. Below
/// `smallest` this share rises towards 1 at the eigenvalue 0; beyond `largest` it grows without bound. The iteration is
/// a polynomial of the matrix, so before and after a correction it makes a symmetric cycle.
/// \source Golub & Varga 1961; as a smoother, Adams, Brezina, Hu & Tuminaro 2003
[[nodiscard]] std::vector<ChebyshevStep> chebyshevSteps(int count, double smallest, double largest);

} // namespace palp
