#pragma once
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// The plane that touches a surface at a place.
struct FlatFrame {
    glm::dvec3 place{};                     ///< [m]
    glm::dvec3 normal{}, east{}, north{};   ///< [1] unit, right-handed

    [[nodiscard]] static FlatFrame about(const glm::dvec3& place, const glm::dvec3& normal);

    [[nodiscard]] glm::dvec2 laid(const glm::dvec3& point) const;     ///< straight onto it [m]
    [[nodiscard]] glm::dvec2 unrolled(const glm::dvec3& point) const; ///< as far away as the point is [m]
    [[nodiscard]] glm::dvec3 lifted(const glm::dvec2& along) const;   ///< a vector in it [m]
};

/// Where a noisy surface lies.
struct FlatFit {
    glm::dvec3 place{};  ///< [m]
    glm::dvec3 normal{}; ///< [1] unit
};

/// Fits a paraboloid to points about a place and returns where it lies straight over that; the place itself if there
/// are too few. Points count (1 - d^2/r^2)^2.
/// \param radius  r [m]
[[nodiscard]] FlatFit flatFit(const FlatFrame& frame, std::span<const glm::dvec3> points, double radius);

} // namespace palp
