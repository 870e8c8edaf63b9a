#pragma once
#include <vector>

namespace palp {

/// w after = w + ahead (w - w before it) + step (residual of w) / divisor.
struct ChebyshevStep {
    float ahead; ///< [1] 0 in the first
    float step;  ///< [1]
};

/// Chebyshev's iteration of so many steps, for a symmetric matrix: what remains of an error along an eigenvector is at
/// most 1/T((largest + smallest)/(largest - smallest)) for eigenvalues, relative to the divisor, from `smallest` to
/// `largest`, T Chebyshev's polynomial of that degree; below `smallest` it falls towards 1 at 0, and beyond `largest`
/// it grows without bound. A polynomial of the matrix: before and after a correction it makes a symmetric cycle.
/// \source Golub & Varga 1961; as a smoother, Adams, Brezina, Hu & Tuminaro 2003
[[nodiscard]] std::vector<ChebyshevStep> chebyshevSteps(int count, double smallest, double largest);

} // namespace palp
