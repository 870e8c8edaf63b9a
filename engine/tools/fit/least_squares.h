#pragma once
#include <functional>
#include <span>
#include <vector>

namespace palp::fit {

/// A parameter of a model, and what is known of it before.
struct Parameter {
    double start = 0, low = 0, high = 0;
};

struct LeastSquares {
    std::vector<double> parameters;
    std::vector<double> deviations;  ///< standard deviations of the parameters; infinite where nothing determines one
    double              squares = 0; ///< sum of the squared residuals
    std::size_t         freedom = 0; ///< residuals less parameters
    bool                settled = false;
};

/// Finds the parameters that make the sum of squared residuals least, by Levenberg's and Marquardt's steps that end at
/// the bounds, with slopes from central differences.
///
/// Deviations are those of the linear model at the end: s^2 (J^T J)^-1 with s^2 = squares / freedom. They hold for
/// residuals that are independent and alike; those of one curve hang together, so true ones are wider.
/// \param residuals  fills the second from the first, always as many; not finite: no such parameters
/// \source Marquardt 1963, "An algorithm for least-squares estimation of nonlinear parameters"
///         (Eigen's module of that method is unsupported and knows no bounds)
[[nodiscard]] LeastSquares
leastSquares(std::span<const Parameter> parameters, std::size_t residualCount,
             const std::function<void(std::span<const double>, std::span<double>)>& residuals);

/// Returns the factor of a deviation that makes a 95 % interval: Student's t.
/// \param freedom  at least 1; below 3 the factor is too small by up to a third
[[nodiscard]] double studentFactor(std::size_t freedom) noexcept;

} // namespace palp::fit
