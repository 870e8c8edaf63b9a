#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/chart/curvature_field.h"
#include "engine/cloud/soft_object.h"

namespace palp {

/// The points of a touched surface that have a place in the chart.
struct LaidPoints {
    std::span<const std::uint32_t> ranks;     ///< along the curve of the object's index
    std::span<const ChartPoint>    positions; ///< [m] as many
    std::span<const glm::dvec3>    normals;   ///< [1] as many, towards the finger
};

/// Returns the fits of one radius of the ladder at those sites of the object that are among the points. What is not
/// known from earlier touches is fitted, and kept with the object.
/// \param rung  see rungRadius()
/// \thread any; starts threads
[[nodiscard]] std::vector<CurvatureSite> curvatureSites(const SoftObject& object, const LaidPoints& points, int rung,
                                                        FitsFor what);

/// Returns the curvature of one face of the object about a place, within a radius [m]; empty where the points determine
/// none.
[[nodiscard]] std::optional<LocalCurvature> faceCurvature(const SoftObject& object, const glm::dvec3& place,
                                                          const glm::dvec3& outward, double radius);

/// Returns the error that noise leaves in a curvature [1/m]: kFitNoiseError noise spacing / radius^3.
/// \param noise, spacing, radius  of the points and of the fit [m]
[[nodiscard]] double fitError(double noise, double spacing, double radius) noexcept;

/// Returns the radius from which on that is 0.5 1/m or less [m].
/// \param noise, spacing  of the points [m]
[[nodiscard]] double quietFitRadius(double noise, double spacing) noexcept;

/// Returns the principal curvatures of a fit [1/m], the larger by size first.
[[nodiscard]] std::pair<double, double> principalOf(const LocalCurvature& fit) noexcept;

} // namespace palp
