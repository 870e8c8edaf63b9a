#pragma once
#include <span>

#include "engine/core/extremes.h"

namespace palp {

/// Writes rigidities for the shaders: relative to a unit, in 32 bits.
/// \param rigidities, unit  [N m], > 0
/// \return the least and the largest rigidity [N m]
/// \throws Error if products of three of them and more would not stay finite
Extremes inRigidityUnits(std::span<const double> rigidities, double unit, std::span<float> relative);

} // namespace palp
