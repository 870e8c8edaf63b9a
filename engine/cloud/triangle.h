#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// Three points of a cloud by their index, in the order of the file. The file's author chose which side is the outer
/// one.
using Triangle = std::array<std::uint32_t, 3>;

/// Triangles and their own vertices, apart from the points of a cloud.
struct SurfaceMesh {
    std::vector<glm::dvec3> vertices; ///< [m]
    std::vector<Triangle>   faces;    ///< of the vertices
};

} // namespace palp
