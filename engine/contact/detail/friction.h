#pragma once
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// Dry friction as a share of the way that the proxy may slide.
///
/// With depth N along the normal, and t [m] the way from the proxy to where it would rest, the hand's pull has the
/// tangent |t| / N: below `hold` nothing slides; a proxy that slides stays `slip` N behind.
struct Friction {
    double hold     = 0; ///< [1]
    double slip     = 0; ///< [1]
    bool   slipping = false;

    /// Decides whether the tool sticks. To be called once per tick: inside the iteration it would depend on rounding.
    void decide(const glm::dvec3& way, double depth) noexcept
    {
        constexpr double kReached = 1.001; // [1] the iteration ends this close to the cone
        const double     length   = glm::length(way);
        slipping                  = slipping ? length > kReached * slip * depth : length > hold * depth;
    }

    /// Returns the part of the way that friction leaves [m].
    [[nodiscard]] glm::dvec3 shortened(const glm::dvec3& way, double depth) const noexcept
    {
        if (hold == 0) return way;
        const double length = glm::length(way);
        if (!slipping || length <= slip * depth) return glm::dvec3(0);
        return way * (1 - slip * depth / length);
    }
};

} // namespace palp
