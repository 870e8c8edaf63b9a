#pragma once
#include <array>
#include <optional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// The plane that touches a surface at a place.
struct FlatFrame {
    glm::dvec3 place{};                   ///< [m]
    glm::dvec3 normal{}, east{}, north{}; ///< [1] unit, right-handed

    [[nodiscard]] static FlatFrame about(const glm::dvec3& place, const glm::dvec3& normal);

    [[nodiscard]] glm::dvec2 laid(const glm::dvec3& point) const;     ///< straight onto it [m]
    [[nodiscard]] glm::dvec2 unrolled(const glm::dvec3& point) const; ///< as far away as the point is [m]
    [[nodiscard]] glm::dvec3 lifted(const glm::dvec2& along) const;   ///< a vector in it [m]
};

/// A paraboloid over a plane: where a noisy surface lies about a place.
struct FlatFit {
    FlatFrame             frame{};
    double                radius = 1; ///< [m]
    std::array<double, 6> of{};       ///< height over the radius, of 1, x, y, x^2, x y, y^2 over it as well [1]

    [[nodiscard]] glm::dvec3 place(const glm::dvec2& along) const;  ///< over a place of the plane [m]
    [[nodiscard]] glm::dvec3 normal(const glm::dvec2& along) const; ///< there, unit [1]
};

/// Fits a paraboloid to points about a place; the plane itself if they are too few. Points count (1 - d^2/r^2)^2.
/// \param radius  r [m]
[[nodiscard]] FlatFit flatFit(const FlatFrame& frame, std::span<const glm::dvec3> points, double radius);

/// A parabola through values along a line.
class CurveFit {
public:
    void add(double at, double value, double share);

    /// Returns its value at 0; empty if fewer than four values determine none.
    [[nodiscard]] std::optional<double> atMiddle() const;

private:
    std::array<double, 5> powers_{}; ///< sums of the shares times at^n
    std::array<double, 3> values_{}; ///< of these times the values
    int                   count_ = 0;
};

} // namespace palp
