#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// The shape of the surface about a point, from the points around it.
struct LocalShape {
    glm::dvec3  normal{};         ///< [1] unit; 0 if the points determine no plane
    double      narrow   = 0;     ///< [1] the smaller over the larger extent of the points along the surface, squared
    std::size_t count    = 0;     ///< points that the quadric was fitted to
    double      residual = 0;     ///< [m] standard deviation of the points about the fitted quadric
    double      tails    = 3;     ///< [1] kurtosis of the deviations, of more than 40 points: two layers have 1
    bool        sided    = false; ///< the points form two layers, and the normal points away from the other one
    double      apart    = 0;     ///< [m] mean distance of the two faces that fitFace() told apart; 0: it did not

    // The quadric h = q0 + q1 a + q2 b + q3 a^2 + q4 a b + q5 b^2 [m] over a, b [radii], of points that lie nearly in a
    // plane and determine it well; then it holds for the points close to the middle one too.
    bool                  smooth = false;
    glm::dvec3            u{}, v{}; ///< [1] axes of a and b
    std::array<double, 6> quadric{};

    /// Returns the quadric's normal [1] at a place close to the middle point, unit. Requires `smooth`.
    [[nodiscard]] glm::dvec3 normalAt(const glm::dvec3& away, double radius) const noexcept;

    /// Returns how far a place lies above the quadric, along the normal [m].
    [[nodiscard]] double heightOf(const glm::dvec3& away, double radius) const noexcept;
};

/// Fits planes and quadrics to the points about a point.
///
/// The plane is that of the principal axes, each point weighted (1 - d^2 / r^2)^2. Where the heights of the points fall
/// into two layers one over the other, as on a body thinner than its points are apart, the point's own layer counts
/// alone. The residual is that of h ~ alpha + beta a + gamma b + the three second powers, with its degrees of freedom.
/// \thread one; allocates only where it has not had as many points before
class ShapeFitter {
public:
    /// \param away     [m] of the points from the middle one, which is among them
    /// \param radius   [m] within which they lie
    /// \param spacing  [m] around here
    [[nodiscard]] LocalShape fit(std::span<const glm::dvec3> away, double radius, double spacing);

    /// Does the same for a wide ball about a noisy thin body: where the deviations from the quadric fall into two heaps
    /// far apart, which are its two faces, the quadric is that of the middle point's face alone.
    [[nodiscard]] LocalShape fitFace(std::span<const glm::dvec3> away, double radius, double spacing);

private:
    struct Height {
        double      height = 0; ///< [m]
        std::size_t point  = 0;
    };

    /// Heights sorted into two groups.
    struct Cut {
        std::size_t at    = 0; ///< how many lie below it
        double      share = 0; ///< [1] of the variance that lies between the groups
    };

    Cut                cutByHeight(std::span<const glm::dvec3> away, const glm::dvec3& normal);
    Cut                bestCut();
    [[nodiscard]] bool areLayers(std::span<const glm::dvec3> away, const glm::dvec3& normal, double spacing,
                                 std::size_t cut) const;
    bool               keepOwnLayer(std::span<const glm::dvec3> away, glm::dvec3 normal, double variance, double radius,
                                    double spacing);

    std::vector<glm::dvec3> own_; ///< [m] scratch: the points that count
    std::vector<Height>     heights_;
};

} // namespace palp
