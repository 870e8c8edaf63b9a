#pragma once
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/chart/chart.h"
#include "engine/core/grid.h"

namespace palp {

/// Half side of a square without an end [m].
inline constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// Unrolls a piece of surface onto the tangent plane at an origin: each point goes to the chart position whose distance
/// and direction are those of the straightest way to it along the surface.
///
/// Points get their places in the order of their distance, as in Dijkstra's search. A point that has its place predicts
/// those of its neighbours: its own plus the edge between them, laid into the chart by axes that were carried along
/// from the origin without twisting. A point's place is the weighted mean of all predictions of neighbours that had
/// theirs before it. Two points are neighbours if the longer of their steps spans them and their normals are less than
/// a right angle apart. Planes, cylinders and all that can be unrolled keep their lengths, with no limit at the
/// hemisphere; a sphere comes out as in the azimuthal equidistant map, with errors of some K d^2 times the spacing, K
/// the Gaussian curvature. Behind a hole lengths are those of the straight line through it. Where two ways around an
/// object meet, points take the shorter one.
///
/// \param origin     [m] on or near the surface; the nearest point is its neighbour from however far
/// \param frame      axes of the chart at the origin; the normals of the points near it agree with its normal
/// \param positions  [m] points of one connected piece of surface, finite
/// \param normals    [1] unit, with signs that agree along the surface; one for each point
/// \param steps      [m] longest edge at each point, finite, >= 0; two local spacings suit
/// \param reach      [m] largest distance from the origin
/// \param careful    [m] half side of the square about the origin outside of which a point takes the first prediction
///                   that it gets from there, without the mean of all: enough for what only moves along
/// \return one position [m] for each point, empty where the search did not come within the reach. The same bits for the
///         same points in any order, unless two are equally far
/// \throws ContractViolation naming the first argument that is not as above
/// \thread pure; allocates once, in proportion to the number of neighbours
/// \source Schmidt, Grimm and Wyvill 2006, "Interactive decal compositing with discrete exponential maps"; averages of
///         all earlier neighbours as in Schmidt 2013, "Stroke parameterization"
/// \differs an edge is laid into the tangent plane half way between its normals and lengthened from chord to arc, so
///          that a cylinder is exact, whereas a tangent plane at one end is off by the square of the edge's angle.
///          Weights count edges along the way from the origin more than those across it: an edge across is too long on
///          a sphere.
[[nodiscard]] std::vector<std::optional<ChartPoint>> exponentialMap(const glm::dvec3& origin, const Frame& frame,
                                                                    std::span<const glm::dvec3> positions,
                                                                    std::span<const glm::dvec3> normals,
                                                                    std::span<const double> steps, double reach,
                                                                    double careful = kEverywhere);

} // namespace palp
