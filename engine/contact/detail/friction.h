#pragma once
#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// Dry friction as a share of the way that the proxy may slide.
///
/// With depth N along the normal, and t [m] the way from the proxy to where it would rest, the hand's pull has the
/// tangent |t| / N: below `hold` nothing slides; a proxy that slides stays `slip` N behind. Where it lets go it gets
/// from one to the other within 20 ms, because a finger that is kicked feels an edge that is not there: 0.2 of a newton
/// within two ticks, at every turn of a stroke. Skin lets go as slowly.
struct Friction {
    double hold; ///< [1]
    double slip; ///< [1] at most `hold`
    bool   slipping = false;

    Friction(double atRest, double sliding) noexcept : hold(atRest), slip(sliding) {}

    /// Decides whether the tool sticks. To be called once per tick: inside the iteration it would depend on rounding.
    void decide(const glm::dvec3& way, double depth) noexcept
    {
        constexpr double kReached = 1.001; // [1] the iteration ends this close to the cone
        constexpr double kLetGo   = 20;    // [ticks] from `hold` to `slip`
        if (hold == 0) return;             // without friction everything slides, and nothing slips
        const double length = glm::length(way);
        now_                = slipping ? std::max(slip, now_ - (hold - slip) / kLetGo) : hold;
        slipping            = length > (slipping ? kReached : 1.0) * now_ * depth;
    }

    /// Returns the part of the way that friction leaves [m].
    [[nodiscard]] glm::dvec3 shortened(const glm::dvec3& way, double depth) const noexcept
    {
        if (hold == 0) return way;
        const double length = glm::length(way);
        if (!slipping || length <= now_ * depth) return glm::dvec3(0);
        return way * (1 - now_ * depth / length);
    }

private:
    double now_ = 0; ///< [1] of the tick
};

} // namespace palp
