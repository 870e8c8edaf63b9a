#pragma once
#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

#include "device/velocity_filter.h"

namespace palp {

/// An arm like the Novint Falcon. Mass and damping: one published free-oscillation measurement (0.459 kg; 2.8 N s/m
/// net, 3.2 to 4.0 with the loss of sampling added back), friction lumped into the damping. Encoder: 320 slots x 4 on a
/// drive of 7.72 move the grip by 25 to 55 um a count, 48 um sideways at the centre. Workspace: a cube of 4 inches.
struct SimulatedArmSettings {
    double     mass           = 0.46;  ///< [kg]
    double     damping        = 3.2;   ///< [N s/m]
    double     friction       = 0;     ///< [N] Coulomb's, against the motion; a few 0.01 N are plausible
    double     encoderStep    = 48e-6; ///< [m] per axis; 0 means continuous
    double     velocityWindow = 15e-3; ///< [s] over which positions are differenced; drivers use 15 to 20 ms
    double     halfWorkspace  = 0.05;  ///< [m] per axis; the arm stops dead there
    double     boxRadius      = 0.045; ///< [m] of the sphere about the origin in which ArmState::inBox is true
    int        delayTicks     = 1;     ///< from a force to its effect, 0 to 7; in addition to the hold over a tick
    glm::dvec3 weight{};               ///< [N] by which gravity pulls the grip; see fallingArm()
};

/// Returns an arm that gravity pulls: 0.21 kg of it weigh on the grip, along -y. One author's driver carries a Falcon
/// by a command that means 0.21 kg at 4200 counts per N m [I].
[[nodiscard]] SimulatedArmSettings fallingArm();

/// A hand that pulls the grip by a spring and a damper to a place that moves at constant velocity.
struct SimulatedHand {
    double     stiffness = 0;    ///< [N/m] 0 for none; a relaxed hand has 150, a firm one 500
    double     damping   = 0;    ///< [N s/m] 0 to 5
    glm::dvec3 target{};         ///< [m] now
    glm::dvec3 targetVelocity{}; ///< [m/s]
};

/// The state of the arm that a device's driver would know.
struct ArmState {
    double     time = 0;     ///< [s]
    glm::dvec3 position{};   ///< [m] in whole encoder steps
    glm::dvec3 velocity{};   ///< [m/s] of those positions, over the window
    bool       inBox = true; ///< the grip is inside the box
};

/// An arm and the hand that holds it, in virtual time: the device of a stability test. The same steps give the same
/// states, bit for bit.
///
///     force --delay--> hold over the tick --> mass, damper, friction, hand --> encoder --> state
///
/// Between ticks the motion solves the differential equation to rounding (a Taylor series of order 10 over at most
/// 125 us, valid for hand springs up to 1e6 N/m). Friction acts along the last velocity of each such piece, and the arm
/// comes to rest where its motion reverses.
/// \thread one
class SimulatedArm {
public:
    /// \throws Error naming a setting out of its range
    explicit SimulatedArm(const SimulatedArmSettings& settings = {}, const glm::dvec3& position = {},
                          const glm::dvec3& velocity = {});

    /// Sets the place and the strength of the hand from now on; between ticks its target moves at constant velocity.
    void holdBy(const SimulatedHand& hand) noexcept { hand_ = hand; }

    /// Does one tick: the motors take over `force` (after the delay) and hold it for the period.
    /// \param force   [N] on the hand; one that is not finite counts as zero
    /// \param period  [s] if not above zero or not finite, no time passes
    /// \return the state at the end of the period
    ArmState step(const glm::dvec3& force, double period) noexcept;

    [[nodiscard]] ArmState          state() const noexcept;
    [[nodiscard]] const glm::dvec3& position() const noexcept { return position_; } ///< [m] true, between encoder steps
    [[nodiscard]] const glm::dvec3& velocity() const noexcept { return velocity_; } ///< [m/s] true

private:
    static constexpr std::size_t kDelays = 8; ///< size of the ring of delayed forces

    [[nodiscard]] glm::dvec3 encoded() const noexcept;
    void                     move(const glm::dvec3& force, double dt) noexcept;
    void                     stopAtWalls() noexcept;

    SimulatedArmSettings            settings_;
    SimulatedHand                   hand_{};
    double                          time_ = 0; ///< [s]
    glm::dvec3                      position_;
    glm::dvec3                      velocity_;
    std::array<glm::dvec3, kDelays> forces_{};
    std::size_t                     tick_ = 0;
    VelocityFilter                  velocityFilter_; ///< of positions in encoder steps
};

} // namespace palp
