#pragma once
#include <array>
#include <cstddef>
#include <limits>

namespace palp {

/// How the tangent of a sheet's force changes with the depth of the hand because the sheet is pressed far: flat ones
/// harden, domes give way. Between knots it is even, beyond the last it stays.
struct DepthShape {
    static constexpr int kSteps = 16;
    using Tangents              = std::array<double, std::size_t(kSteps) + 1>;

    double   step = 0;   ///< [m] of depth from knot to knot; 0: there is no shape
    Tangents tangents{}; ///< over that at the surface, which is 1; 0 or more [1]

    /// Returns false if a number of it is not finite or below zero: nothing of it may then be felt.
    [[nodiscard]] bool usable() const noexcept;

    bool operator==(const DepthShape&) const = default;
};

/// Returns the shape a share of the way from one to another; none counts as a straight one.
[[nodiscard]] DepthShape between(const DepthShape& from, const DepthShape& to, double share) noexcept;

/// The elastic force of a contact over its depth d. It is the one place that knows how a contact stiffens: force,
/// tank, governor, lean and pictures take tangent and stored energy from here.
///
///     F(d) = K (e^{b d} - 1) / b        tangent K e^{b d}        energy K (e^{b d} - 1 - b d) / b^2
///
/// up to the depth at which the tangent reaches the cap; from there on F is straight with that slope. b = 0 is the
/// spring F = K d, to the bit.
///
/// Where the sheet's shape is known the tangent is K s(d) e^{b S(d)}, s the shape and S its integral: at the shape's
/// knots, at most the cap, and even between them. Force and energy are its integrals, exactly.
///
/// Plate and contact stiffen together, by one factor: the dent is that of the load K d, whatever F is.
/// \source Fung 1967, "Elasticity of soft tissues in simple elongation": the tangent grows in proportion to the force
/// \thread a value; no function allocates, locks or throws
struct DepthLaw {
    double     stiffness  = 0;                                       ///< K [N/m] at the surface, at most `steepest`
    double     stiffening = 0;                                       ///< b [1/m]
    double     steepest   = std::numeric_limits<double>::infinity(); ///< the cap of the tangent [N/m]
    DepthShape shape{};

    /// Returns the law of a stiffness that may be above the cap.
    [[nodiscard]] static DepthLaw capped(double stiffness, double stiffening, double cap,
                                         const DepthShape& shape = {}) noexcept
    {
        return {stiffness < cap ? stiffness : cap, stiffening, cap, shape};
    }

    /// Returns whether it is the spring F = K d.
    [[nodiscard]] bool isSpring() const noexcept { return stiffening == 0 && shape.step == 0; }

    // All below take depths of 0 or more [m].
    [[nodiscard]] double force(double depth) const noexcept;   ///< [N]
    [[nodiscard]] double secant(double depth) const noexcept;  ///< force per depth [N/m]; at 0 the tangent
    [[nodiscard]] double tangent(double depth) const noexcept; ///< [N/m]
    [[nodiscard]] double energy(double depth) const noexcept;  ///< stored [J]

    /// Returns the largest tangent down to a depth [N/m], by which a loop may swing: of a dome that at the surface.
    [[nodiscard]] double mostTangent(double depth) const noexcept;

    /// Returns the depth of a force of 0 or more [m]; where the force stays the same, the least.
    [[nodiscard]] double depthOf(double force) const noexcept;

    bool operator==(const DepthLaw&) const = default;

private:
    struct Place;                                       ///< between two knots of the shape
    [[nodiscard]] double straightFrom() const noexcept; ///< depth at which the cap is met [m]
    [[nodiscard]] Place  at(double depth) const noexcept;
    [[nodiscard]] double shapedDepthOf(double force) const noexcept;
};

} // namespace palp
