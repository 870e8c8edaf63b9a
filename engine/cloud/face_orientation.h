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

/// What turnOutward() has turned.
struct TurnedOutward {
    std::size_t faces = 0, normals = 0;
};

/// Turns closed surfaces that lie inside out, so that their triangles face away from what they enclose, and normals of
/// their points to the same side.
///
/// Closed is a surface of triangles that hang together over edges, if two of them, which face the same way, meet at
/// each; it lies inside out if the volume that it encloses, counted with the sign that its triangles give it, is
/// negative. One whose box lies within that of a larger closed one is taken for the wall of its cavity and turned with
/// it, or not, as it is; of the hundred largest ones, so that the time is linear. Open surfaces, whose sides are
/// nobody's to tell, keep all of their bits.
/// \param faces      of differing corners; turned by exchanging the last two
/// \param positions  of the corners [m]
/// \param normals    of the corners, 0 where none is known, or none; those of a closed surface are turned if they point
///                   inward for the larger part of its area
TurnedOutward turnOutward(std::span<Triangle> faces, std::span<const glm::dvec3> positions,
                          std::span<glm::vec3> normals = {});

} // namespace palp
