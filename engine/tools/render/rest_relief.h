#pragma once
#include <span>
#include <vector>

#include <glm/vec3.hpp>

// Internal to engine/tools/render.

namespace palp {

/// How far the surroundings of each point rise above its tangent plane, in units of their distance, at two radii, as
/// view_light.frag has it for what one sees: of an object at rest, so that a picture that moves shows it as a still
/// does. \param positions, normals  of the points; those of one side of the object on one side [m], [1] \param spacing
/// between points [m], above 0 \param radius              of the nearer surroundings [m], above 0
[[nodiscard]] std::vector<double> restRelief(std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
                                             double spacing, double radius);

} // namespace palp
