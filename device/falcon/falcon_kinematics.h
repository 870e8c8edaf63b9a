#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

namespace palp {

/// Lengths and angles of a Novint Falcon: three equal legs hold the grip between them, each a thigh on a motor and a
/// shin of two parallel rods.
///
/// The maker has published no drawing. All values are libnifalcon's (BSD-3, include/falcon/core/FalconGeometry.h and
/// FalconKinematic.h), whose offsets of the base were revised twice; its authors call the result poor at the edges of
/// the workspace. The values are therefore settings, not constants.
struct FalconGeometry {
    double thigh    = 60e-3;     ///< [m] from the motor's axle to the elbow
    double shin     = 102.5e-3;  ///< [m] the rods of the shin
    double joints   = 22.5e-3;   ///< [m] of both joints of the shin, 11.25 mm each, which do not swing sideways
    double gripOut  = 14.43e-3;  ///< [m] from the middle of the grip outwards to the shin's end
    double gripSide = -25e-3;    ///< [m] and sideways
    double baseOut  = 40e-3;     ///< [m] from the device's axis outwards to the axle
    double baseSide = -23.09e-3; ///< [m] and sideways

    /// [rad] about the device's axis, from x towards y: 105, -15 and -135 degrees; top leg first, then clockwise seen
    /// from the front.
    std::array<double, 3> azimuths{1.832595714594046, -0.261799387799149, -2.356194490192345};

    double zeroAngle     = 0.610865238198015; ///< [rad] 35 degrees: angle of the thigh at encoder reading 0
    double countsPerTurn = 1280;              ///< [counts] per turn of the motor: 320 slots, four edges each
    double driveRatio    = 110.0 / 14.25; ///< [1] turns of the motor per turn of the thigh: radii of sector and capstan

    [[nodiscard]] double countsPerRadian() const noexcept; ///< 1572.56 as shipped
};

/// The kinematics of a Falcon: positions of the grip from angles of the thighs, forces from torques, and their
/// inverses.
///
/// Frame: x right, y up, z towards the user, the origin on the device's axis in the plane of the axles; the grip is at
/// about z = 75 to 175 mm. A leg stands at its azimuth phi and works in its own frame: u outwards, v sideways, w = z,
///
///     u = x cos phi + y sin phi - baseOut,   v = -x sin phi + y cos phi - baseSide,   w = z.
///
/// Thigh and shin swing in the plane (u, w) by t1 and t2, the rods sideways by t3. With L = joints + shin sin t3 a leg
/// closes where
///
///     u = thigh cos t1 - gripOut + L cos t2,   v = shin cos t3 - gripSide,   w = thigh sin t1 + L sin t2.
///
/// Arrays of three have an entry per leg: angles t1 [rad] and torques about its axis [N m], positive where a thigh
/// swings outwards.
/// \source   the closure is that of R. E. Stamper, "A Three Degree of Freedom Parallel Manipulator with Only
///           Translational Degrees of Freedom" (PhD thesis, University of Maryland, 1997), as libnifalcon applies it
/// \differs  from libnifalcon, where the third column of the Jacobian has sin^2 t2 in place of sin t2 sin t3, and where
///           the Newton iteration stops at 0.01 rad
/// \thread   const and pure; no allocation
class FalconKinematics {
public:
    /// \throws Error naming a length or an angle that is impossible
    explicit FalconKinematics(const FalconGeometry& geometry = {});

    [[nodiscard]] const FalconGeometry& geometry() const noexcept { return geometry_; }

    /// Returns the angles of the thighs with the grip at `position` [m]; empty where a leg does not reach.
    [[nodiscard]] std::optional<std::array<double, 3>> angles(const glm::dvec3& position) const noexcept;

    /// Returns the position of the grip [m] with the thighs at `angles`, by Newton's method to 1e-9 rad.
    /// \param start  [m] first guess, the last position; one out of reach counts as the middle, (0, 0, 125 mm)
    /// \return empty where 20 steps do not suffice: an arm cannot have these angles, or it is singular there
    [[nodiscard]] std::optional<glm::dvec3> position(const std::array<double, 3>& angles,
                                                     const glm::dvec3&            start = kMiddle) const noexcept;

    /// Returns the Jacobian: row i is d angle_i / d position [rad/m] of leg i; empty where a leg does not reach, or
    /// near a singularity.
    [[nodiscard]] std::optional<std::array<glm::dvec3, 3>> jacobian(const glm::dvec3& position) const noexcept;

    /// Returns the torques of the motors [N m] that push the hand at `position` [m] with `force` [N]; empty where
    /// jacobian() is, or where the force is not finite.
    [[nodiscard]] std::optional<std::array<double, 3>> torques(const glm::dvec3& position,
                                                               const glm::dvec3& force) const noexcept;

    /// Returns the force on the hand [N] of these torques, the inverse of torques(); empty where jacobian() is.
    [[nodiscard]] std::optional<glm::dvec3> force(const glm::dvec3&            position,
                                                  const std::array<double, 3>& torques) const noexcept;

    /// Returns the angles that these counts of the encoders mean.
    [[nodiscard]] std::array<double, 3> angles(const std::array<std::int16_t, 3>& counts) const noexcept;

    /// Returns the counts of the encoders at these angles, not rounded.
    [[nodiscard]] std::array<double, 3> counts(const std::array<double, 3>& angles) const noexcept;

    /// Middle of the workspace [m], as in VRPN's driver. That of the largest ball in reach of all legs is 3 mm further
    /// out.
    static constexpr glm::dvec3 kMiddle{0, 0, 0.125};

private:
    /// The three legs at one position of the grip.
    struct Pose {
        std::array<double, 3>     angles{};        ///< [rad] t1
        std::array<glm::dvec3, 3> rows{};          ///< [rad/m] of the Jacobian; not finite where a leg is stretched
        bool                      regular = false; ///< far enough from every singularity to compute with the rows
    };
    [[nodiscard]] std::optional<Pose> pose(const glm::dvec3& position) const noexcept;

    FalconGeometry        geometry_;
    std::array<double, 3> cosAzimuth_, sinAzimuth_;
};

} // namespace palp
