#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "device/falcon/falcon_motors.h"
#include "device/haptic_device.h"

namespace palp {

struct FalconCalibrationSettings {
    double     mass            = 0.2; ///< [kg] known mass on the grip; FalconCalibration::kLeastMass to kMostMass
    double     countsPerTorque = FalconMotors::kCountsPerTorque; ///< [counts/(N m)] with which it begins
    glm::dvec3 up{0, 1, 0};                                      ///< [1] against gravity, in the device's frame
    double     gravity = 9.81;                                   ///< [m/s2]
};

enum class FalconCalibrationStage : std::uint8_t {
    lift,   ///< finds counts with which the arm is carried
    bare,   ///< weighs the arm alone
    hang,   ///< holds still: hang the mass on the grip, then call hung()
    loaded, ///< weighs arm and mass
    done,
    failed ///< see failure()
};

/// Finds how many counts a motor needs for a torque, with a known mass on the grip.
///
/// It scales itself: while the arm hangs at rest on the motors, before it is weighed, the counts per torque in use are
/// changed until it seems to weigh what a Falcon's arm is likely to, 0.21 kg. With them the mass is held as well,
/// whether the counts that were known first are too few or too many, such as those of libnifalcon, 2.38 times ours. No
/// motor's number jumps by that.
///
/// The wanted force holds the grip at a place that goes up and down by 8 mm in 4 s. Over whole periods its mean is the
/// weight, independent of friction and inertia. With F0 and F1 [N] the means without and with the mass, as commanded
/// with G counts per torque, the motors truly have
///
///     G' = G (F1 - F0) / (mass gravity),
///
/// which goes into FalconLoopSettings::countsPerTorque. A G' beyond the bounds of FalconMotors by more than 5 % (else
/// it is the bound) is a failure: the mass is not the given one, or something else was weighed. So is an arm of more
/// than 0.4 kg. Each weighing takes a quarter of a minute, hands off.
///
///     1  home the device; lift the grip to the middle of its workspace and hold it there loosely
///     2  each tick: device.useCounts(countsInUse()), state = device.exchange(force), then governor.step() with
///        step()'s force; let go as force comes on
///     3  at `hang`: hang the mass on the grip, wait until it hangs still, call hung()
///     4  at `done`: countsPerTorque()
///
/// The governor's 6 N bound what can be weighed. While an arm is taken for one of 0.21 kg, within 8 %, these hold a
/// mass of 1.3 times the arm. kMostMass is held beside every arm of 0.18 to 0.39 kg, also by weak motors: with 10 000
/// counts per N m these hold 5.9 N, arm included, and then it takes an arm of at most 0.25 kg.
/// \thread one
class FalconCalibration {
public:
    static constexpr double kLeastMass = 0.05; ///< [kg] below, the motors' steps err by more than 2 %
    static constexpr double kMostMass  = 0.25; ///< [kg] see above

    /// \throws Error naming a setting out of its range
    explicit FalconCalibration(const FalconCalibrationSettings& settings = {});

    /// Does one tick.
    /// \param sent  the force that the device was last given [N]
    /// \param gain  [1] of the governor; below 1 nothing is weighed, at 0 the place to hold is where the grip is
    /// \param dt    [s] since the last tick
    /// \return the force wanted [N], for the governor
    glm::dvec3 step(const HapticState& state, const GovernedForce& sent, double gain, double dt) noexcept;

    /// Returns the counts per torque that the device is to use now [counts/(N m)].
    [[nodiscard]] double countsInUse() const noexcept { return counts_; }

    void hung() noexcept; ///< says that the mass hangs; ignored at any stage but `hang`

    [[nodiscard]] FalconCalibrationStage stage() const noexcept { return stage_; }
    [[nodiscard]] const char*            failure() const noexcept { return failure_; } ///< one sentence, or empty

    [[nodiscard]] std::optional<double> countsPerTorque() const noexcept; ///< [counts/(N m)] once done
    [[nodiscard]] std::optional<double> armMass() const noexcept;         ///< [kg] of the arm on the grip; once done

private:
    static constexpr int kPeriods = 4; ///< periods of a weighing: two to settle, two to measure

    void start(FalconCalibrationStage stage) noexcept;
    void scaleCounts(const HapticState& state, double upwards, const glm::dvec3& away, double dt) noexcept;
    void useCounts(double counts) noexcept;
    void endPeriod() noexcept;
    void fail(const char* why) noexcept;

    [[nodiscard]] double foundCountsPerTorque() const noexcept; ///< [counts/(N m)] by both means

    FalconCalibrationSettings    settings_;
    double                       counts_; ///< [counts/(N m)] in use
    FalconCalibrationStage       stage_   = FalconCalibrationStage::lift;
    const char*                  failure_ = "";
    glm::dvec3                   anchor_{};                 ///< [m] middle of the motion of the place to hold
    glm::dvec3                   integral_{};               ///< [N]
    double                       lifting_ = 0, rested_ = 0; ///< [s] in the stage; at rest
    double                       time_ = 0;                 ///< [s] since the period began
    double                       sum_  = 0;                 ///< [N s] of the force upwards in the period
    std::array<double, kPeriods> means_{};                  ///< [N] of the periods
    int                          periods_ = 0;
    double                       bare_ = 0, loaded_ = 0; ///< [N] F0 and F1
};

} // namespace palp
