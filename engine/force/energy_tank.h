#pragma once
#include <limits>

#include "engine/force/depth_law.h"

namespace palp {

/// Settings of the tank. All are from simulation of press, slide and release on an arm of 0.46 kg and 3.2 N s/m, with
/// edges 6 mm wide, 2 to 5 mm deep, at 0.05 and 0.2 m/s, and stiffness from 100 to 1000 N/m.
struct EnergyTankSettings {
    double limit = 2e-3;   ///< [J] the most it holds; what one step of stiffness may inject at once
    double start = 0.2e-3; ///< [J] at the beginning
    /// [N s/m] the most of the arm's own damping that fills it. An arm of 3.2 spends 1.5 on the sampled spring at the
    /// cap, K (T/2 + delay) = 1000 (0.5 ms + 1 ms); 1 of the remaining 1.7.
    double damping = 1;
    double power   = 1e-3; ///< [W] fills it at rest too; 0 is strict, and a still finger never feels a spot harden
};

struct EnergyTankInput {
    double stiffness       = 0; ///< [N/m] wanted at the surface: min(force law, ForceGovernor::stiffnessCap())
    double depth           = 0; ///< [m] of the hand in the surface; 0 or less is no contact
    double normalSpeed     = 0; ///< [m/s] along the surface's normal; the sign does not matter
    double tangentialSpeed = 0; ///< [m/s] along the surface; the sign does not matter
    double dt              = 0; ///< [s] since the last tick
    /// [m^2] -pull · way of the proxy along the surface in this tick: times the stiffness it is what the hand paid to
    /// drag the proxy there, or below zero what it was given on the way down a slope
    double drag = 0;
    /// [N s/m] that the spring leaves of the arm's damping: ForceGovernor::spareDamping().
    double spareDamping = std::numeric_limits<double>::infinity();
    double stiffening   = 0;                                       ///< [1/m] wanted, see DepthLaw
    double steepest     = std::numeric_limits<double>::infinity(); ///< [N/m] cap of its tangent
    /// [1] of the elastic energy that the contact stores: below 1 where its material has relaxed, see RelaxingContact.
    double     storedShare = 1;
    DepthShape shape{}; ///< of the sheet, wanted
};

struct EnergyTankOutput {
    double   stiffness = 0; ///< [N/m] to render at the surface; at most the wanted one
    double   used      = 0; ///< [J] that the tank let into the hand: GovernorInput::admittedEnergy
    double   stored = 0; ///< [J] in the rendered spring, K depth^2 / 2 of a straight one: GovernorInput::storedEnergy
    DepthLaw law{};      ///< to render, with that stiffness
};

/// Pays for stiffness that rises under a loaded finger. A contact of depth d stores d^2 K / 2, or what its DepthLaw
/// says. What the hand changes of it by sliding it pays, or gets, itself through the tangential part of its pull, see
/// LateralLean. What is left comes from outside: a new table, an offset that dies, a cap that rises. A small store that
/// the arm's damping fills pays for a rise of that kind; what cannot be paid waits, and the stiffness lags.
///
/// The servo calls it, once a tick, between the force law and the governor:
///
///     K = min(law, governor.stiffnessCap()) -> tank.step() -> force = secant pull -> governor.step()
///
/// Invariants: 0 <= energy() <= limit; the stiffness rises in contact only by what was paid. This bounds growth, and is
/// not strict passivity: damping and power let in a few mJ per second.
/// \thread one
class EnergyTank {
public:
    /// \throws Error naming a setting that is negative or not finite
    explicit EnergyTank(const EnergyTankSettings& settings = {});

    /// Runs one tick. Values that are not finite end the contact with stiffness 0 and an empty tank; a negative dt
    /// counts as 0.
    EnergyTankOutput step(const EnergyTankInput& in) noexcept;

    [[nodiscard]] double energy() const noexcept { return energy_; }           ///< [J] in the tank
    [[nodiscard]] double stiffness() const noexcept { return law_.stiffness; } ///< [N/m] in use

private:
    void takePartOf(const DepthLaw& wanted, double depth, double share) noexcept;

    EnergyTankSettings settings_;
    double             energy_;
    DepthLaw           law_; // in use
};

} // namespace palp
