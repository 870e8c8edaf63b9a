#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/soft_object.h"

namespace palp {

/// A node of a coarse mesh of a whole object.
struct BodyNode {
    glm::dvec3 place{};      ///< [m] on the surface, without the points' noise
    glm::dvec3 normal{};     ///< [1] unit, of either sign
    double     rigidity = 0; ///< D, the geometric mean of the points that are nearer to this node than to others [N m]
    bool       held     = false; ///< it lies where what is held begins
};

/// A triangle of it.
struct BodyTriangle {
    std::array<std::uint32_t, 3> nodes{};
    double                       share = 1; ///< of it that counts [1]: of its nodes, those that it is a neighbour of
};

/// A coarse mesh of the surface of a whole object, up to its own borders and to where it is held. What is held has no
/// nodes but those where it begins.
struct BodyMesh {
    std::vector<BodyNode>     nodes;
    std::vector<BodyTriangle> triangles;
    double                    spacing = 0; ///< least distance of two nodes along the surface, but for borders [m]
};

/// Makes it, from the points alone.
///
/// Nodes are points none of which is within `spacing` of another one along the surface: first those where the object is
/// held and those of its borders, moved outwards by half a distance of the points, because a border lies that much
/// beyond the points that it has; then the rest. Each node has the triangles that a Delaunay triangulation of those
/// around it has, laid flat about it. On a curved surface neighbours need not agree: a triangle counts by the share of
/// its three nodes that have it.
/// \param most  nodes, about
/// \return  without nodes if the points determine no surface
/// \thread any; starts none
/// \source  Gopi, Krishnan and Silva 2000, surface reconstruction based on lower dimensional localized Delaunay
///          triangulation: the stars
/// \differs they keep the triangles that all three nodes have, and so leave holes
[[nodiscard]] BodyMesh bodyMesh(const SoftObject& object, std::size_t most);

} // namespace palp
