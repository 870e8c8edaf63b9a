#pragma once
#include <span>

#include "engine/core/extremes.h"

namespace palp {

/// Returns the unit of rigidities up to this one: a power of four, so that numbers relative to it, and the square roots
/// of these in factors, have the same digits whatever the unit is.
/// \param largest  [N m], > 0
[[nodiscard]] double rigidityUnit(double largest) noexcept;

/// Returns whether a unit serves for rigidities from the least to the largest [N m]: products of several of them stay
/// far from the ends of 32 bits.
[[nodiscard]] bool isUnitOf(double unit, const Extremes& rigidity) noexcept;

/// Writes rigidities for the shaders: relative to a unit, in 32 bits.
/// \param rigidities, unit  [N m], > 0
/// \return the least and the largest rigidity [N m]
/// \throws Error if products of three of them and more would not stay finite
Extremes inRigidityUnits(std::span<const double> rigidities, double unit, std::span<float> relative);

} // namespace palp
