#pragma once
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "engine/tools/render/camera.h"

namespace palp {

struct Ray {
    glm::dvec3 from{};          ///< [m]
    glm::dvec3 along{0, 0, -1}; ///< [1] unit
};

/// Returns the ray from the eye through a place of the picture.
/// \param at    from the picture's upper left corner [px]
/// \param size  of the picture [px]
[[nodiscard]] Ray rayThrough(const Camera& camera, const glm::dvec2& at, const glm::dvec2& size);

/// A place on a surface of points and its side towards the eye.
struct Hit {
    glm::dvec3 point{};          ///< [m]
    glm::dvec3 outward{0, 0, 1}; ///< [1] unit
};

/// Returns where a ray first meets the discs of a cloud: the mean over the points around there, weighted by
/// (1 - d²/R²)² of their distances d from the ray, so that the hand glides as the pointer does. Empty if it misses.
///
/// Looks at every point: 0.1 ms for 40 000.
/// \param positions, normals  of the points [m], [1] unit, of either side
/// \param radii   of the discs [m], as many
/// \param blur    R [m]
[[nodiscard]] std::optional<Hit> pick(const Ray& ray, std::span<const glm::dvec3> positions,
                                      std::span<const glm::dvec3> normals, std::span<const double> radii, double blur);

} // namespace palp
