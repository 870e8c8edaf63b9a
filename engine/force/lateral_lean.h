#pragma once
#include <glm/vec3.hpp>

namespace palp {

/// The surface under one contact, as the lean needs it.
struct StiffnessSlope {
    glm::dvec3 ofLogarithm{}; ///< gradient of ln K along the surface [1/m]
    double     curvature = 0; ///< [1/m] of the surface, positive where it bulges towards the hand
    /// [m^2] stored energy over the force per depth, by which the lean goes with the slope; below 0: that of a spring,
    /// depth^2 / 2
    double leverage = -1;
};

/// The lateral force of a surface whose stiffness changes from place to place, as a lean of the hand.
///
/// A contact of depth d at the place s stores E = K(s) d^2 / 2. Of a force that is the gradient of E one part pushes
/// out, K d, and the other along the surface, away from what is stiffer:
///
///     F_s = -(d^2 / 2) grad K / (1 - curvature d)      the foot of a hand below a bulge goes further than the hand
///
/// Without it the way over a lump is not conservative: with every round the hand gains what the lump stores. With it
/// the lump resists on the way in and pushes on the way out.
///
/// It is rendered through the proxy: the proxy is given a hand that leans by F_s / K, and the pull goes from the true
/// hand to that proxy. Then K pull has the tangent F_s where nothing rubs. And friction judges the tangent that a
/// finger really exerts: while it holds, the proxy stays and K pull is an honest spring; while it slips, the tangent is
/// friction and F_s together. Neither state can be pumped, and where one goes over into the other no force jumps.
///
/// Stiffness and slope are looked up at the proxy less its lean: the foot of the hand itself. Looked up at the proxy
/// they would run away from each other on top of a lump, from a depth of some millimetres on.
/// \thread the servo's; no allocation, lock or throw
class LateralLean {
public:
    /// Runs one tick in contact.
    /// \param slope   of the stiffness, or of what is stored where that is not in proportion
    /// \param pull    [m] from the hand to the proxy, the lean so far included
    /// \param travel  [m] of the hand in this tick
    void step(const StiffnessSlope& slope, const glm::dvec3& pull, double travel) noexcept;

    void end() noexcept { lean_ = {}; } ///< the contact is over

    [[nodiscard]] const glm::dvec3& way() const noexcept { return lean_; } ///< from the hand, for the next tick [m]

private:
    glm::dvec3 lean_{};
};

} // namespace palp
