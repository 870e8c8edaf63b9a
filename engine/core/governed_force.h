#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// A force that a device may render: zero, or one that a ForceGovernor has let through. Nothing else can make one, so
/// that no force bypasses the governor. It lies in core/ because device/ includes nothing else of the engine.
class GovernedForce {
public:
    GovernedForce() = default; ///< zero

    [[nodiscard]] const glm::dvec3& newtons() const noexcept { return newtons_; } ///< [N] on the hand

    /// Returns the same force in another frame.
    /// \param frame  normalized here, so that the magnitude stays
    [[nodiscard]] GovernedForce rotated(const glm::dquat& frame) const noexcept
    {
        return GovernedForce(glm::normalize(frame) * newtons_);
    }

private:
    friend class ForceGovernor;
    explicit GovernedForce(const glm::dvec3& newtons) noexcept : newtons_(newtons) {}

    glm::dvec3 newtons_{}; ///< [N]
};

} // namespace palp
