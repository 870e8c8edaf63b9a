#pragma once

namespace palp {

/// The constants that turn the stiffness of a point into plate numbers; one per scene.
struct Material {
    double thickness    = 4e-3; ///< [m] of the soft sheet; skin 1.5e-3, rubber sheet 4e-3
    double poissonRatio = 0.45; ///< [1] -1 < nu <= 0.5; skin and rubber 0.45 to 0.49

    /// Returns the flexural rigidity of a sheet: D = E h^3 / (12 (1 - nu^2)) [N m].
    /// \param modulus  E [Pa]
    [[nodiscard]] double rigidity(double modulus) const noexcept { return modulus * rigidityPerModulus(); }
    /// Returns the inverse of rigidity() [Pa].
    /// \param rigidity  D [N m]
    [[nodiscard]] double modulus(double rigidity) const noexcept { return rigidity / rigidityPerModulus(); }

private:
    [[nodiscard]] double rigidityPerModulus() const noexcept
    {
        return thickness * thickness * thickness / (12 * (1 - poissonRatio * poissonRatio));
    }
};

} // namespace palp
