#include "engine/tools/fit/least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "engine/core/contract.h"

namespace palp::fit {
namespace {

using Vector    = Eigen::VectorXd;
using Matrix    = Eigen::MatrixXd;
using Residuals = std::function<void(std::span<const double>, std::span<double>)>;

Vector at(const Vector& p, Eigen::Index count, const Residuals& residuals)
{
    Vector r(count);
    residuals({p.data(), std::size_t(p.size())}, {r.data(), std::size_t(count)});
    return r;
}

Matrix slopes(const Vector& p, std::span<const Parameter> known, Eigen::Index count, const Residuals& residuals)
{
    Matrix jacobian(count, p.size());
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const Parameter& bound = known[std::size_t(k)];
        const double     step  = 1e-5 * std::max(1.0, std::abs(p[k])); // the cube root of rounding
        Vector           up = p, down = p;
        up[k]           = std::min(bound.high, p[k] + step);
        down[k]         = std::max(bound.low, p[k] - step);
        jacobian.col(k) = (at(up, count, residuals) - at(down, count, residuals)) / (up[k] - down[k]);
    }
    return jacobian;
}

/// Returns the step with that damping, cut off at the bounds. What stands at a bound and would leave stays.
Vector stepped(const Vector& p, const Matrix& normal, const Vector& gradient, double damping,
               std::span<const Parameter> known)
{
    Matrix damped = normal;
    Vector wish   = gradient;
    for (Eigen::Index k = 0; k < p.size(); ++k) {
        const Parameter& bound = known[std::size_t(k)];
        const bool       stuck = (p[k] <= bound.low && gradient[k] < 0) || (p[k] >= bound.high && gradient[k] > 0);
        if (stuck) {
            damped.row(k).setZero();
            damped.col(k).setZero();
            wish[k] = 0;
        }
        damped(k, k) = stuck ? 1 : normal(k, k) * (1 + damping) + std::numeric_limits<double>::min();
    }
    Vector next = p + damped.ldlt().solve(wish);
    for (Eigen::Index k = 0; k < p.size(); ++k)
        next[k] = std::clamp(next[k], known[std::size_t(k)].low, known[std::size_t(k)].high);
    return next;
}

} // namespace

LeastSquares leastSquares(std::span<const Parameter> parameters, std::size_t residualCount, const Residuals& residuals)
{
    PALP_EXPECT(residualCount > parameters.size(),
                std::to_string(residualCount) + " residuals for " + std::to_string(parameters.size()) + " parameters");
    constexpr int    kMostSteps = 200;
    constexpr double kSettled   = 1e-10; // relative change of the squares that counts as none [1]
    const auto       count      = Eigen::Index(residualCount);
    Vector           p(Eigen::Index(parameters.size()));
    for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = parameters[std::size_t(k)].start;

    LeastSquares result;
    Vector       r       = at(p, count, residuals);
    Matrix       j       = slopes(p, parameters, count, residuals);
    double       damping = 1e-3;
    for (int n = 0; n < kMostSteps && !result.settled; ++n) {
        const Vector next    = stepped(p, j.transpose() * j, -(j.transpose() * r), damping, parameters);
        const Vector tried   = at(next, count, residuals);
        const double squares = tried.squaredNorm(), before = r.squaredNorm();
        if (squares <= before) { // false for what is not finite
            result.settled = before - squares <= kSettled * before;
            p              = next;
            r              = tried;
            damping        = std::max(1e-12, damping / 5);
            if (!result.settled) j = slopes(p, parameters, count, residuals);
        } else {
            damping *= 4;
            result.settled = damping > 1e12; // no step is small enough to gain anything
        }
    }
    result.squares = r.squaredNorm();
    result.freedom = residualCount - parameters.size();
    result.parameters.assign(p.data(), p.data() + p.size());
    const Matrix normal = slopes(p, parameters, count, residuals).transpose() * slopes(p, parameters, count, residuals);
    const Eigen::FullPivLU<Matrix> solver(normal);
    const Matrix                   inverse = solver.isInvertible() ? Matrix(solver.inverse()) : Matrix();
    for (Eigen::Index k = 0; k < p.size(); ++k)
        result.deviations.push_back(inverse.size() > 0 && inverse(k, k) >= 0
                                        ? std::sqrt(inverse(k, k) * result.squares / double(result.freedom))
                                        : std::numeric_limits<double>::infinity());
    return result;
}

double studentFactor(std::size_t freedom) noexcept
{
    constexpr double z  = 1.959964; // the normal distribution's
    const double     n  = double(std::max<std::size_t>(freedom, 1));
    const double     z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
    return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
           (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

} // namespace palp::fit
