#pragma once
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// Finds where the surface passes through a cloud of noisy points, near the place that they are seen from.
///
/// The plane of the principal axes of the nearer points is the first guess. Over it, with a and b the way along the
/// plane, q = a^2 + b^2 and h the height,
///
///     h ~ alpha + beta a + gamma b + K q,    weights (1 - q/r^2)^2 psi
///
/// is fitted some times; psi falls from 1 to 0 between 0.8 and 1.4 scales from the fit before, so that another sheet
/// does not count. The surface passes alpha above the place.
/// \thread one; allocates only where it has not had as many points before
class SurfaceProjector {
public:
    /// Returns the radius [m] within which points are wanted.
    [[nodiscard]] static double reach(double scale) noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
    void                      clear() noexcept { points_.clear(); }
    void                      add(const glm::dvec3& away) { points_.push_back(away); } ///< [m] from the place

    /// Returns the way [m] from the place to the surface; empty if the points are too few, or lie in layers: the
    /// heights of noise have a kurtosis of 3, those of two sheets 1.
    [[nodiscard]] std::optional<glm::dvec3> wayToSurface(double scale);

private:
    struct Site {
        double a = 0, b = 0, q = 0, h = 0; ///< [1] over r, q over r^2
        double fall = 0;                   ///< [1] weight by the way along the plane
    };

    std::vector<glm::dvec3> points_;
    std::vector<Site>       sites_;
};

} // namespace palp
