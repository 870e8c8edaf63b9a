#include "engine/force/lateral_lean.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {

void LateralLean::step(const StiffnessSlope& slope, const glm::dvec3& pull, double travel) noexcept
{
    constexpr double kMost    = 0.5; // [1] of the depth: a slope of 0.2 per mm reaches it 5 mm deep
    constexpr double kFlatter = 0.5; // [1] least 1 - curvature d: deeper, the foot is on another side
    // What a slope can change in a tick: 0.27 of the travel at a step of 100, 3 mm deep. Beyond that it jumps, at the
    // rim of a table or from one table to the next; 0.02 mm are 0.02 N at 1000 N/m, which is not felt as a tick.
    constexpr double kOfTravel = 0.5, kAtRest = 0.02e-3; // [1], [m]

    const double     depth    = glm::length(pull - lean_);
    const double     leverage = slope.leverage >= 0 ? slope.leverage : depth * depth / 2;
    const glm::dvec3 wanted   = -leverage / std::max(kFlatter, 1 - slope.curvature * depth) * slope.ofLogarithm;
    const double     size     = glm::length(wanted);
    if (!std::isfinite(size) || !std::isfinite(travel)) return end();
    const glm::dvec3 change  = (size > kMost * depth ? kMost * depth / size : 1.0) * wanted - lean_;
    const double     changes = glm::length(change), most = kOfTravel * travel + kAtRest;
    lean_ += changes > most ? most / changes * change : change;
}

} // namespace palp
