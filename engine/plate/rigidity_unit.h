#pragma once
#include <span>

#include "engine/core/extremes.h"

namespace palp {

/// A rigidity as the shaders are given it: relative to a unit, in 32 bits.
/// \param rigidity, unit  [N m], > 0
/// \throws Error if products of three of them and more would not stay finite
[[nodiscard]] float inRigidityUnits(double rigidity, double unit);
/// Many of them. \return the least and the largest [N m]
Extremes inRigidityUnits(std::span<const double> rigidities, double unit, std::span<float> relative);

} // namespace palp
