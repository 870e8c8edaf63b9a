#pragma once
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/triangle.h"

namespace palp {

/// Cuts a polygon, which need not be quite flat, into triangles that lie within it.
/// \param corners  in order, three or more [m]
/// \return two triangles fewer than it has corners, by their numbers, which face as the polygon does; nothing where the
///         fan about the first corner lies within it, or where the polygon crosses itself or has too many corners to
///         try
[[nodiscard]] std::optional<std::vector<Triangle>> trianglesOfConcave(std::span<const glm::dvec3> corners);

} // namespace palp
