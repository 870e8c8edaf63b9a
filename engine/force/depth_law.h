#pragma once
#include <limits>

namespace palp {

/// The elastic force of a contact over its depth d. It is the one place that knows how a contact stiffens: force,
/// tank, governor, lean and pictures take tangent and stored energy from here.
///
///     F(d) = K (e^{b d} - 1) / b        tangent K e^{b d}        energy K (e^{b d} - 1 - b d) / b^2
///
/// up to the depth at which the tangent reaches the cap; from there on F is straight with that slope. b = 0 is the
/// spring F = K d, to the bit.
///
/// Plate and contact stiffen together, by one factor: the dent is that of the load K d, whatever F is.
/// \source Fung 1967, "Elasticity of soft tissues in simple elongation": the tangent grows in proportion to the force
/// \thread a value; no function allocates, locks or throws
struct DepthLaw {
    double stiffness  = 0;                                       ///< K [N/m] at the surface, at most `steepest`
    double stiffening = 0;                                       ///< b [1/m]
    double steepest   = std::numeric_limits<double>::infinity(); ///< the cap of the tangent [N/m]

    /// Returns the law of a stiffness that may be above the cap.
    [[nodiscard]] static DepthLaw capped(double stiffness, double stiffening, double cap) noexcept
    {
        return {stiffness < cap ? stiffness : cap, stiffening, cap};
    }

    // All below take depths of 0 or more [m].
    [[nodiscard]] double force(double depth) const noexcept;   ///< [N]
    [[nodiscard]] double secant(double depth) const noexcept;  ///< force per depth [N/m]; at 0 the tangent
    [[nodiscard]] double tangent(double depth) const noexcept; ///< [N/m]
    [[nodiscard]] double energy(double depth) const noexcept;  ///< stored [J]

    /// Returns the depth of a force of 0 or more [m].
    [[nodiscard]] double depthOf(double force) const noexcept;

    bool operator==(const DepthLaw&) const = default;

private:
    [[nodiscard]] double straightFrom() const noexcept; ///< depth at which the cap is met [m]
};

} // namespace palp
