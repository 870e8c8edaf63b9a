#pragma once
#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "device/falcon/falcon_kinematics.h"

namespace palp {

/// The motor numbers for one force.
struct FalconDrive {
    std::array<std::int16_t, 3> motors{};         ///< [counts] for a FalconCommand; at most kMost in magnitude
    double                      scale    = 0;     ///< [1] share of the force that is rendered; below 1: saturated
    bool                        badForce = false; ///< the force was not finite; no force is rendered
    bool                        singular = false; ///< out of reach or near a singularity; no force is rendered
};

/// Converts forces to the numbers for the motors, and back.
///
/// A motor pushes inwards where its number is positive, against the angles of the kinematics: count = -G torque. Where
/// a number would exceed the range, all three shrink by one factor: a weaker force, in the same direction.
/// \thread const and pure; it allocates nothing
class FalconMotors {
public:
    /// Largest number that a motor takes [counts]. Beyond it the vendor's driver scales as above; beyond an int16 the
    /// packet would reverse the force.
    static constexpr std::int16_t kMost = 4095;

    /// G [counts/(N m)]. Most packets of the vendor's driver that libnifalcon holds (util/translate_packet.py) give
    /// 4000 to 4700, with the Jacobian of FalconKinematics and their forces taken as newtons. libnifalcon multiplies by
    /// 10 000. Neither was measured on a device: if the larger one is right, Palpate's forces are too weak. With 4200
    /// the motors hold 14 N in the middle, in any direction.
    static constexpr double kCountsPerTorque = 4200;

    /// Bounds of G [counts/(N m)], the same for every option, setting and calibration. They are for safety: a G that is
    /// k times too large makes every force and every stiffness k times larger than the governor allows. With the
    /// governor's 1000 N/m, a Falcon that needs 4200 gets 2400 N/m at the upper bound, somewhat more than the 2137 N/m
    /// up to which its released arm is stable at 1 kHz; beyond that the loop swings. The upper bound is also the
    /// largest G that a public driver uses. Below the lower bound less than half of a force is rendered, and a
    /// calibration no longer holds its mass.
    static constexpr double kLeastCountsPerTorque = 2000, kMostCountsPerTorque = 10000;

    /// Checks a value of G.
    /// \throws Error if it is out of its bounds or not a number
    static void demandCountsPerTorque(double countsPerTorque);

    /// \param countsPerTorque  [counts/(N m)] G
    /// \throws Error where demandCountsPerTorque() does
    explicit FalconMotors(const FalconKinematics& kinematics      = FalconKinematics{},
                          double                  countsPerTorque = kCountsPerTorque);

    /// \param countsPerTorque  [counts/(N m)] moved into the bounds
    void setCountsPerTorque(double countsPerTorque) noexcept;

    /// Computes the motor numbers for a force.
    /// \param position  [m] of the grip, in the frame of the kinematics
    /// \param force     [N] on the hand
    [[nodiscard]] FalconDrive drive(const glm::dvec3& position, const glm::dvec3& force) const noexcept;

    /// Returns the torques [N m] that these numbers give.
    [[nodiscard]] std::array<double, 3> torques(const std::array<std::int16_t, 3>& motors) const noexcept;

private:
    FalconKinematics kinematics_;
    double           countsPerTorque_; ///< [counts/(N m)]
};

} // namespace palp
