#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "engine/cloud/point_cloud_io.h"
#include "engine/session/scene.h"

namespace palp {

/// The points that stand for the faces of a scene's mesh, before they are made.
struct ScatterPlan {
    double      spacing     = 0; ///< of the mesh's vertices: root of the area of each [m]
    double      longestEdge = 0; ///< of a triangle [m]
    double      area        = 0; ///< of all triangles [m^2]
    double      fingertip   = 0; ///< radius that decided [m]
    double      wanted      = 0; ///< least distance between two points [m]
    double      distance    = 0; ///< the same, or more where the points would be too many [m]
    std::size_t points      = 0; ///< about as many
};

/// Decides whether a cloud with faces is touched through points that are scattered over them.
///
/// A finger that presses between vertices feels nothing there. So they must be about a quarter of the fingertip apart.
/// The key `scatter` = auto keeps them if they are, and if no edge of a triangle is both longer than a quarter of the
/// fingertip and four times the spacing; else points a fifth of the fingertip apart take their place, which is a
/// spacing of 0.23 fingertips.
/// \return nothing if the cloud's own points are touched
/// \throws Error if the scene asks for points on a mesh and there is none
[[nodiscard]] std::optional<ScatterPlan> scatterPlan(const Scene& scene, const LoadedCloud& loaded);

/// Returns why a mesh is refused on which so many points as can be made lie farther apart than the fingertip's radius;
/// empty if it is not.
[[nodiscard]] std::string scatterRefusal(const ScatterPlan& plan);

/// Returns the scene with the points of its file, unless somebody asks for points on the faces: what converts or paints
/// a file keeps its vertices.
[[nodiscard]] Scene withPointsOfFile(Scene scene);

/// Puts points on the faces in place of the vertices, with the stiffness between their corners and the normals of the
/// faces. Vertices and faces become the cloud's mesh, which pictures draw. The report says so.
void scatterOverFaces(LoadedCloud& loaded, const ScatterPlan& plan);

} // namespace palp
