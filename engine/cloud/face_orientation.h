#pragma once
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "engine/cloud/triangle.h"

namespace palp {

/// Turns triangles round until neighbours face the same way.
///
/// Two triangles that share an edge, and share it with no third, pass along it in opposite directions if they face the
/// same way. Of triangles that hang together over such edges those with the smaller part of the area are turned, so
/// that a mesh without flipped triangles keeps all of its bits; of equal parts the first triangle stays. A surface with
/// one side only, such as a Moebius strip, keeps a seam.
/// \param faces      of differing corners; turned by exchanging the last two
/// \param positions  of the corners [m]
/// \return the number of triangles that were turned
std::size_t turnToNeighbours(std::span<Triangle> faces, std::span<const glm::dvec3> positions);

/// Turns a closed surface that lies inside out, so that its triangles face away from what it encloses.
///
/// Closed is a surface each of whose edges belongs to two triangles; it lies inside out if the volume that it encloses,
/// counted with the sign that its triangles give it, is negative. A body with cavities is one surface here: their walls
/// face into them before and after. An open surface, whose sides are nobody's to tell, and one whose triangles do not
/// face as their neighbours do keep all of their bits.
/// \param faces      of differing corners; turned, all or none, by exchanging the last two
/// \param positions  of the corners [m]
/// \return whether they were turned
bool turnOutward(std::span<Triangle> faces, std::span<const glm::dvec3> positions);

} // namespace palp
