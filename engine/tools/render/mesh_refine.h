#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/triangle.h"

namespace palp {

/// A mesh to draw: its vertices are split into corners where faces meet at an edge that is seen as one, so that each
/// part has a normal of its own. A vertex of a cube becomes three corners.
struct CreasedMesh {
    std::vector<glm::dvec3>    positions; ///< of the corners [m]
    std::vector<glm::dvec3>    normals;   ///< of the corners, of either side [1]
    std::vector<std::uint32_t> placeOf;   ///< for each corner the number of its place, shared by those of one vertex
    std::vector<Triangle>      faces;     ///< of the corners
};

/// Faces whose normals differ by less than 40 degrees, either side of them, meet smoothly: a corner's normal is the
/// mean of its faces' by area.
[[nodiscard]] CreasedMesh creased(const SurfaceMesh& mesh);

/// Halves edges that are longer than some, the longest first, until none is left or the triangles would be too many.
/// Triangles that share an edge share its middle, with the mean of its ends' normals, and those that meet at a crease
/// share the place: no gap opens between them. A triangle becomes two to four.
/// \param longest  edge that stays [m], > 0
/// \param most     triangles; a mesh that has more stays as it is
/// \return with the corners of a place one after the other
[[nodiscard]] CreasedMesh refined(CreasedMesh mesh, double longest, std::size_t most);

/// The faces about each corner.
struct Fans {
    std::vector<std::uint32_t> first; ///< for each corner where its faces begin; one more at the end
    std::vector<std::uint32_t> faces; ///< corner by corner

    Fans() = default;
    Fans(std::span<const Triangle> all, std::size_t corners);
    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t corner) const noexcept
    {
        return std::span(faces).subspan(first[corner], first[corner + 1] - first[corner]);
    }
};

/// Returns the mean of the faces' normals by area, on the side of the first of them [1].
/// \param positions  of the faces' corners [m]
[[nodiscard]] glm::dvec3 meanNormal(std::span<const glm::dvec3> positions, std::span<const Triangle> all,
                                    std::span<const std::uint32_t> faces);

} // namespace palp
