#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cloud/triangle.h"

namespace palp {

/// The most points that scatterOver() makes: about 0.6 GB of object and proxy, and half a minute to get them ready.
inline constexpr std::size_t kMostMeshPoints = 4'000'000;

struct ScatterSettings {
    double        distance = 0; ///< least between two points [m], > 0
    std::uint64_t seed     = 1;
    std::size_t   most     = kMostMeshPoints; ///< points, > 0
};

/// Points that stand for the surface of a mesh.
struct MeshPoints {
    double                  wanted   = 0; ///< the distance that was asked for [m]
    double                  distance = 0; ///< least between two points; larger than `wanted` if they were too many [m]
    double                  area     = 0; ///< of all triangles [m^2]
    std::size_t             degenerate = 0; ///< triangles without an area
    std::vector<glm::dvec3> positions;      ///< [m]
    std::vector<glm::dvec3> normals;        ///< of the triangles, to the side from which their corners run left [1]
    std::vector<std::uint32_t> triangles;   ///< on which each point lies, as an index into the faces
    std::vector<glm::dvec2>    weights;     ///< of the triangle's second and third corner [1]; the first has the rest

    [[nodiscard]] std::size_t size() const noexcept { return positions.size(); }
};

/// Scatters points over a mesh so that no two lie closer than a distance and no more would find room: a maximal
/// Poisson-disc set. Every place of the surface has a point within 1 + 1/64 times the distance.
///
/// Distances are straight lines, so a set is also maximal across edges, between triangles that no edge joins, and where
/// sheets intersect. Two sheets that face opposite ways, as those of a thin plate, hold sets of their own, unless they
/// are closer than a fiftieth of the distance. It is indifferent to holes, to edges with any number of triangles,
/// to triangles that occur twice or are turned round.
///
/// The distance grows until area / distance^2 is at most `most`, and where long thin triangles would take long: see
/// scatterDistance(). It is doubled where points are still too many.
/// \param vertices  finite [m]
/// \param faces     of the vertices
/// \return as many points as find room, about 0.76 area / distance^2; none if no triangle has an area. The same bits on
///         every machine
/// \thread pure; allocates
/// \source Ebeida, Mitchell, Patney, Davidson & Owens 2012, "A simple algorithm for maximal Poisson-disk sampling in
///         high dimensions"; on meshes Corsini, Cignoni & Scopigno 2012, "Efficient and flexible sampling with blue
///         noise properties of triangular meshes"
/// \differs no darts are thrown over the mesh as a whole: each triangle is halved, in the order of space, until one
///          disc covers a part; parts smaller than a disc get a dart each. Memory is then read in order, and the sets
///          are a little denser than random ones: about 0.76 points on distance^2 instead of 0.70
[[nodiscard]] MeshPoints scatterOver(std::span<const glm::dvec3> vertices, std::span<const Triangle> faces,
                                     const ScatterSettings& settings);

/// Returns the distance that scatterOver() begins with [m]: the one that is asked for, or a larger one, so that neither
/// a large surface nor a few kilobytes of long thin triangles take hours.
[[nodiscard]] double scatterDistance(std::span<const glm::dvec3> vertices, std::span<const Triangle> faces,
                                     const ScatterSettings& settings);

/// Returns the values of the points, from those of the vertices, weighted as the points lie between the corners.
/// \param values  of the vertices
[[nodiscard]] std::vector<double> interpolated(const MeshPoints& points, std::span<const Triangle> faces,
                                               std::span<const double> values);

/// Returns the values of the points, from those of the vertices by the mean of their logarithms, weighted as the points
/// lie between the corners.
/// \param values  of the vertices, > 0
[[nodiscard]] std::vector<double> logInterpolated(const MeshPoints& points, std::span<const Triangle> faces,
                                                  std::span<const double> values);

} // namespace palp
