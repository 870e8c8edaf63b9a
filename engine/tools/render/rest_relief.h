#pragma once
#include <span>
#include <vector>

#include <glm/vec3.hpp>

// Internal to engine/tools/render.

namespace palp {

/// Returns how far the surroundings of each point of an object at rest rise above its tangent plane, in units of their
/// distance, at two radii, as view_light.frag does for visible places, so that a moving picture looks like a still.
/// \param positions, normals  of the points; those of one side of the object on one side [m], [1]
/// \param spacing             between points [m], above 0
/// \param radius              of the nearer surroundings [m], above 0
[[nodiscard]] std::vector<double> restRelief(std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
                                             double spacing, double radius);

} // namespace palp
