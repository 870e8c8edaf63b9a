#pragma once
#include <vector>

#include "engine/plate/plate.h"

namespace palp::report {

/// Returns the deflection of a beam with the plate's rigidity, clamped at the side z1 and free at z0, under a force in
/// the middle.
///
/// It is Euler and Bernoulli's beam of a plate's strip: E I(z) = (1 - nu^2) int D(x, z) dx, for its sides are free to
/// curl. With s from the root and the load at s = a the moment is F (a - s) up to the load and zero beyond:
///
///     w'' = M / (E I),   w = w' = 0 at the root,   integrated by the trapezoidal rule over the grid's rows
///
/// \param force  [N]
/// \return deflection at the nodes of the middle line, from z0 (the tip) to z1 (the root) [m]
/// \source Timoshenko, "Strength of Materials": the cantilever; (1 - nu^2) undoes the plate's D = E h^3/(12 (1 - nu^2))
[[nodiscard]] std::vector<double> cantilever(const Plate& plate, double force);

} // namespace palp::report
