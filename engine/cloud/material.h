#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace palp {

/// How a material gives way under a finger that holds still: shares of its force die away, each in its own time.
///
/// G(t) = 1 - sum g_i (1 - e^{-t / tau_i}) is what is left of a force after a time. Meat under a ball 0.26 in 0.41 s
/// and 0.31 in 4.3 s; silicone phantoms 0.48 in 3.8 s.
/// \source Fung 1972, quasi-linear viscoelasticity; the terms are a Prony series
struct Relaxation {
    static constexpr std::size_t kMostTerms = 3;

    struct Term {
        double share = 0; ///< g [1] of the force at once, above 0
        double time  = 1; ///< tau [s]

        bool operator==(const Term&) const = default;
    };
    std::array<Term, kMostTerms> terms{};
    std::size_t                  count = 0; ///< of terms; 0: nothing dies away

    /// Returns the share of the force that dies away in the end [1].
    [[nodiscard]] double shares() const noexcept
    {
        double sum = 0;
        for (std::size_t n = 0; n < count; ++n) sum += terms[n].share;
        return sum;
    }
    bool operator==(const Relaxation&) const = default;
};

inline constexpr std::string_view kRelaxationForm =
    "up to three SHARE@TIME, whose shares are below 1 together, such as 0.26@0.41s,0.31@4.3s, or none";

/// Reads kRelaxationForm.
/// \throws Error that opens with `what`
[[nodiscard]] Relaxation parseRelaxation(std::string_view text, std::string_view what);

/// Writes it so that parseRelaxation() reads the same values back.
[[nodiscard]] std::string relaxationText(const Relaxation& relaxation);

/// The largest b [1/m]: a force that grows by e after 10 um; no finger tells it from a wall.
inline constexpr double kMostStiffening = 1e5;

/// The least and the largest foundation of a point [Pa/m]; a micrometre of steel has less.
inline constexpr double kLeastFoundation = 1, kMostFoundation = 1e15;

/// Returns e^(b d) at d = 0.1 mm, by how much the tangent of a force has grown there [1]. What takes the mean of
/// logarithms, or paints in them, then takes that of b, zeros included.
/// \param stiffening  b, 0 to kMostStiffening [1/m]
[[nodiscard]] double growthOf(double stiffening) noexcept;
/// Returns the inverse of growthOf() [1/m]; 0 for what rounding has brought below 1.
[[nodiscard]] double stiffeningOf(double growth) noexcept;

/// The constants that turn the stiffness of a point into plate numbers and forces; one per scene.
struct Material {
    double     thickness    = 4e-3; ///< [m] of the soft sheet; skin 1.5e-3, rubber sheet 4e-3
    double     poissonRatio = 0.45; ///< [1] -1 < nu <= 0.5; skin and rubber 0.45 to 0.49
    double     stiffening   = 0;    ///< b [1/m], see DepthLaw; liver and meat under a ball 800; 0: none
    Relaxation relaxation{};        ///< of the force; no terms: none

    /// Returns the flexural rigidity of a sheet: D = E h^3 / (12 (1 - nu^2)) [N m].
    /// \param modulus  E [Pa]
    [[nodiscard]] double rigidity(double modulus) const noexcept { return modulus * rigidityPerModulus(); }
    /// Returns the inverse of rigidity() [Pa].
    /// \param rigidity  D [N m]
    [[nodiscard]] double modulus(double rigidity) const noexcept { return rigidity / rigidityPerModulus(); }
    /// Returns true if the force is stiffness times depth, now and later.
    [[nodiscard]] bool isLinear() const noexcept { return stiffening == 0 && relaxation.count == 0; }

private:
    [[nodiscard]] double rigidityPerModulus() const noexcept
    {
        return thickness * thickness * thickness / (12 * (1 - poissonRatio * poissonRatio));
    }
};

} // namespace palp
