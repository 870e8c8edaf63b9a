#include "engine/force/depth_law.h"

#include <cmath>

namespace palp {
namespace {

/// Returns (e^x - 1 - x) / x^2, which tends to 1/2.
double secondRest(double x) noexcept
{
    constexpr double kSmall = 0.01; // below it the series is right to 1e-12, above it the difference to 1e-12
    if (x < kSmall) return 0.5 + x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x / 720)));
    return (std::expm1(x) - x) / (x * x);
}

} // namespace

double DepthLaw::straightFrom() const noexcept
{
    return stiffness > 0 ? std::log(steepest / stiffness) / stiffening : std::numeric_limits<double>::infinity();
}

double DepthLaw::force(double depth) const noexcept
{
    if (stiffening == 0) return stiffness * depth;
    const double bend = straightFrom();
    if (depth <= bend) return stiffness * std::expm1(stiffening * depth) / stiffening;
    return (steepest - stiffness) / stiffening + steepest * (depth - bend);
}

double DepthLaw::secant(double depth) const noexcept
{
    return stiffening == 0 || !(depth > 0) ? stiffness : force(depth) / depth;
}

double DepthLaw::tangent(double depth) const noexcept
{
    if (stiffening == 0) return stiffness;
    return depth <= straightFrom() ? stiffness * std::exp(stiffening * depth) : steepest;
}

double DepthLaw::energy(double depth) const noexcept
{
    if (stiffening == 0) return stiffness * depth * depth / 2;
    const double bend   = straightFrom();
    const double curved = depth < bend ? depth : bend, beyond = depth - curved;
    const double below = stiffness * secondRest(stiffening * curved) * curved * curved;
    return beyond > 0 ? below + ((steepest - stiffness) / stiffening + steepest * beyond / 2) * beyond : below;
}

double DepthLaw::depthOf(double force) const noexcept
{
    if (!(stiffness > 0)) return 0;
    if (stiffening == 0) return force / stiffness;
    const double curved = (steepest - stiffness) / stiffening; // [N] where the cap is met
    if (force <= curved) return std::log1p(stiffening * force / stiffness) / stiffening;
    return straightFrom() + (force - curved) / steepest;
}

} // namespace palp
