#include "engine/force/depth_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

bool DepthShape::usable() const noexcept
{
    return std::isfinite(step) && step >= 0 &&
           std::ranges::all_of(tangents, [](double t) { return std::isfinite(t) && t >= 0; });
}

DepthShape between(const DepthShape& from, const DepthShape& to, double share) noexcept
{
    if (from == to) return to;
    DepthShape shape;
    const bool fromNone = from.step == 0, toNone = to.step == 0;
    shape.step = fromNone ? to.step : toNone ? from.step : std::lerp(from.step, to.step, share);
    for (std::size_t n = 0; n < shape.tangents.size(); ++n)
        shape.tangents[n] = std::lerp(fromNone ? 1 : from.tangents[n], toNone ? 1 : to.tangents[n], share);
    return toNone && share >= 1 ? DepthShape{} : shape;
}

/// A depth, what comes before the knot above it, and the tangent there, which changes by `change` in a metre.
struct DepthLaw::Place {
    double force = 0, energy = 0; ///< at the knot above [N], [J]
    double tangent = 0;           ///< at the knot above [N/m]
    double change  = 0;           ///< [N/m^2]
    double below   = 0;           ///< from the knot to the depth [m]
    double most    = 0;           ///< largest tangent from the surface to the knot [N/m]

    [[nodiscard]] double tangentHere() const noexcept { return tangent + change * below; }
    [[nodiscard]] double forceHere() const noexcept { return force + (tangent + change * below / 2) * below; }
    [[nodiscard]] double energyHere() const noexcept
    {
        return energy + (force + (tangent / 2 + change * below / 6) * below) * below;
    }
};

DepthLaw::Place DepthLaw::at(double depth) const noexcept
{
    const double step  = shape.step;
    double       grown = 0; // S of the shape [m]
    const auto   knot  = [&](std::size_t n) {
        return std::min(steepest, stiffness * shape.tangents[n] * (stiffening > 0 ? std::exp(stiffening * grown) : 1));
    };
    Place here{.tangent = knot(0), .below = depth};
    here.most = here.tangent;
    for (std::size_t n = 0; n < std::size_t(DepthShape::kSteps); ++n) {
        grown += (shape.tangents[n] + shape.tangents[n + 1]) / 2 * step;
        const double next = knot(n + 1);
        here.change       = (next - here.tangent) / step;
        if (here.below < step) return here;
        const double rest = here.below - step;
        here.below        = step;
        here              = {here.forceHere(), here.energyHere(), next, 0, rest, std::max(here.most, next)};
    }
    return here;
}

double DepthLaw::straightFrom() const noexcept
{
    return stiffness > 0 ? std::log(steepest / stiffness) / stiffening : std::numeric_limits<double>::infinity();
}

double DepthLaw::force(double depth) const noexcept
{
    if (shape.step > 0) return at(depth).forceHere();
    if (stiffening == 0) return stiffness * depth;
    const double bend = straightFrom();
    if (depth <= bend) return stiffness * std::expm1(stiffening * depth) / stiffening;
    return (steepest - stiffness) / stiffening + steepest * (depth - bend);
}

double DepthLaw::secant(double depth) const noexcept
{
    return isSpring() || !(depth > 0) ? stiffness : force(depth) / depth;
}

double DepthLaw::tangent(double depth) const noexcept
{
    if (shape.step > 0) return at(depth).tangentHere();
    if (stiffening == 0) return stiffness;
    return depth <= straightFrom() ? stiffness * std::exp(stiffening * depth) : steepest;
}

double DepthLaw::mostTangent(double depth) const noexcept
{
    if (!(shape.step > 0)) return tangent(depth);
    const Place here = at(depth);
    return std::max(here.most, here.tangentHere());
}

double DepthLaw::energy(double depth) const noexcept
{
    if (shape.step > 0) return at(depth).energyHere();
    if (stiffening == 0) return stiffness * depth * depth / 2;
    const double bend   = straightFrom();
    const double curved = depth < bend ? depth : bend, beyond = depth - curved;
    const double below = stiffness * secondRest(stiffening * curved) * curved * curved;
    return beyond > 0 ? below + ((steepest - stiffness) / stiffening + steepest * beyond / 2) * beyond : below;
}

double DepthLaw::shapedDepthOf(double force) const noexcept
{
    const double end = DepthShape::kSteps * shape.step;
    const Place  far = at(std::numeric_limits<double>::infinity()); // beyond the last knot
    if (force > far.force) return far.tangent > 0 ? end + (force - far.force) / far.tangent : end;
    const auto  halfway = [&](std::size_t n) { return (double(n) + 0.5) * shape.step; }; // rounding takes no other step
    std::size_t low = 0, high = std::size_t(DepthShape::kSteps); // the force at `low` is below, at `high` it is not
    while (high - low > 1) {
        const std::size_t middle                         = (low + high) / 2;
        (at(halfway(middle)).force < force ? low : high) = middle;
    }
    const Place  here = at(halfway(low));
    const double more = std::max(0.0, force - here.force);
    const double root = std::sqrt(std::max(0.0, here.tangent * here.tangent + 2 * here.change * more));
    const double down = here.tangent + root; // 2 x of x (t + t') / 2 = more, without a difference
    return double(low) * shape.step + (down > 0 ? std::min(2 * more / down, shape.step) : 0);
}

double DepthLaw::depthOf(double force) const noexcept
{
    if (!(stiffness > 0)) return 0;
    if (shape.step > 0) return shapedDepthOf(force);
    if (stiffening == 0) return force / stiffness;
    const double curved = (steepest - stiffness) / stiffening; // [N] where the cap is met
    if (force <= curved) return std::log1p(stiffening * force / stiffness) / stiffening;
    return straightFrom() + (force - curved) / steepest;
}

} // namespace palp
