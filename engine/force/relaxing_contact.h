#pragma once
#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

#include "engine/cloud/material.h"
#include "engine/force/depth_law.h"

namespace palp {

/// The force of a contact whose material relaxes.
///
/// With F_e the elastic force of the depth, a Prony term gets used to a part of it:
///
///     F = F_e - sum g_i m_i        tau_i dm_i/dt = F_e - m_i
///
/// which is quasi-linear viscoelasticity, integral of G(t - s) dF_e(s). A tick is taken as a ramp of F_e, and solved
/// exactly. What the contact stores beside what it has lost,
///
///     V = E(d) - sum g_i (E(s_i) + m_i (d - s_i))        s_i the depth at which F_e is m_i, E the elastic energy
///
/// is never below zero for a rising F_e (E is convex, and each bracket is a tangent of E), and loses
/// g_i (d - s_i) (F_e - m_i) / tau_i >= 0 in a time: no closed stroke gives energy.
///
/// Where F would pull, the surface has left the finger: it stays behind at the depth where F is 0, and comes up in its
/// own time. A finger that comes back meets it there.
///
/// What the contact got used to belongs to a place. While the finger slides it fades, within a footprint's radius,
/// towards fresh material, which is stiffer; the energy of that is taken from what this contact has lost since it
/// began, and where that is not enough the fading waits. A place within a quarter of a millimetre is the same place,
/// because hands and encoders tremble.
///
/// Memories are kept as depths s_i: where the stiffness changes from place to place, or from one table to the next,
/// force and stored energy change by the same factor as those of the elastic law.
/// \thread one; no allocation, lock or throw
/// \source Fung 1972; Simo and Hughes 1998, "Computational Inelasticity", section 10.3 for the recurrence
class RelaxingContact {
public:
    /// \param fadeLength  [m] of sliding in which e^-1 is left of what the contact got used to; above zero
    RelaxingContact(const Relaxation& relaxation, double fadeLength) noexcept
        : relaxation_(relaxation), fadeLength_(fadeLength)
    {
    }

    struct Tick {
        DepthLaw   law;       ///< elastic
        double     depth = 0; ///< [m] of the hand; 0 or less is no contact
        glm::dvec3 place{};   ///< [m] of the contact, in free space of the hand
        double     dt = 0;    ///< [s] since the last tick
    };
    struct Output {
        double force     = 0; ///< [N] of 0 or more
        double stored    = 0; ///< V [J]
        double refreshed = 0; ///< [J] by which sliding raised V
    };
    /// Runs one tick. Values that are not finite forget everything.
    Output step(const Tick& now) noexcept;

    /// Returns the depth of the material's surface: that of the hand, or deeper where the surface stays behind [m].
    [[nodiscard]] double surface() const noexcept { return surface_; }
    /// Returns V per elastic energy at that depth [1]; 1 without contact.
    [[nodiscard]] double storedShare() const noexcept { return storedShare_; }
    [[nodiscard]] bool   relaxes() const noexcept { return relaxation_.count > 0; }

private:
    using Depths = std::array<double, Relaxation::kMostTerms>;

    [[nodiscard]] double storedAt(const DepthLaw& law, double depth, const Depths& used) const noexcept;
    [[nodiscard]] double restingDepth(const DepthLaw& law) const noexcept;
    [[nodiscard]] double fade(const DepthLaw& law, const glm::dvec3& place) noexcept;
    void                 relax(const DepthLaw& law, double depth, double dt) noexcept;

    Relaxation relaxation_;
    double     fadeLength_;
    Depths     used_{};          // s [m]
    double     surface_     = 0; // [m]
    double     depth_       = 0; // of the hand, in the last tick [m]
    double     lost_        = 0; // since this contact began, less what fading took [J]
    double     storedShare_ = 1;
    glm::dvec3 place_{}; // that the memory belongs to [m]
    bool       placed_ = false;
};

} // namespace palp
