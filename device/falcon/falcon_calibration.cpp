#include "device/falcon/falcon_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "device/detail/setting_range.h"
#include "device/falcon/falcon_constants.h"

namespace palp {
namespace {

constexpr double      kStroke    = 8e-3; ///< [m] each way: some hundred counts, and wider than static friction
constexpr double      kPeriod    = 4;    ///< [s] 13 mm/s at most
constexpr double      kStiffness = 300;  ///< [N/m] a third of what the loop holds; the arm's own damping suffices
constexpr double      kIntegral  = 300;  ///< [N/(m s)] the weight is found with a time constant of a second
constexpr double      kMostForce = 5.7;  ///< [N] below the governor's 6, beyond which a mean is meaningless
constexpr double      kLeast     = 0.1;  ///< [N] least weight of the mass
constexpr double      kArm       = 2.06; ///< [N] likely weight of an arm: 0.21 kg [I]
constexpr double      kAlike     = 0.08; ///< [1] share by which it may seem to differ
constexpr double      kRest      = 0.5;  ///< [s] of rest before the counts are changed
constexpr double      kAtRest = 1e-3, kSlow = 3e-3; ///< [m], [m/s] of an arm at rest
constexpr double      kMostLift = 20;               ///< [s] an arm of another weight is weighed all the same
constexpr double      kBeyond   = 0.05;             ///< [1] of a bound that is taken for the bound: masses err by less
constexpr double      kSpread   = 0.05; ///< [N] most difference of the two measured periods; a touch causes more
constexpr const char* kTooHeavy = "arm and mass could not be held: take a lighter mass";

} // namespace

FalconCalibration::FalconCalibration(const FalconCalibrationSettings& settings)
    : settings_(settings), counts_(settings.countsPerTorque)
{
    demandRange("calibration", "mass", settings.mass, kLeastMass, kMostMass);
    FalconMotors::demandCountsPerTorque(settings.countsPerTorque);
    demandRange("calibration", "gravity", settings.gravity, 9, 10);
    demandRange("calibration", "the length of up", glm::length(settings.up), 1 - 1e-6, 1 + 1e-6);
}

glm::dvec3 FalconCalibration::step(const HapticState& state, const GovernedForce& sent, double gain, double dt) noexcept
{
    using Stage = FalconCalibrationStage;
    if (stage_ == Stage::done || stage_ == Stage::failed) return {};
    if (!(gain > 0) || state.fault != DeviceFault::none || !(dt > 0)) { // the governor has let go: start again
        anchor_   = state.position;
        integral_ = {};
        if (stage_ == Stage::loaded) fail(kTooHeavy); // it fell out of its workspace
        if (stage_ == Stage::bare || stage_ == Stage::lift) start(Stage::lift);
        return {};
    }
    const bool   isWeighing = gain >= 1 && stage_ != Stage::hang && stage_ != Stage::lift;
    const double lift       = isWeighing ? kStroke * std::sin(2 * std::numbers::pi * time_ / kPeriod) : 0;
    const auto   away       = state.position - (anchor_ + lift * settings_.up);
    const double upwards    = glm::dot(sent.newtons(), settings_.up);
    integral_ -= kIntegral * dt * away;
    if (stage_ == Stage::lift && gain >= 1) scaleCounts(state, upwards, away, dt);
    if (isWeighing) {
        if (periods_ >= kPeriods / 2 && glm::length(sent.newtons()) > kMostForce) {
            fail(kTooHeavy);
            return {};
        }
        sum_ += upwards * dt;
        time_ += dt;
        if (time_ >= kPeriod) endPeriod();
    }
    return integral_ - kStiffness * away;
}

/// Changes the counts in use while the arm hangs at rest, or while the force is near the governor's limit.
void FalconCalibration::scaleCounts(const HapticState& state, double upwards, const glm::dvec3& away,
                                    double dt) noexcept
{
    constexpr double kNearLimit = 4, kStep = 1.25; // [N], [1] of one change
    const bool       isHeld = glm::length(away) < kAtRest && glm::length(state.velocity) < kSlow;
    lifting_ += dt;
    rested_ = isHeld || upwards > kNearLimit ? rested_ + dt : 0;
    if (rested_ < kRest) {
        if (lifting_ > kMostLift) start(FalconCalibrationStage::bare);
        return;
    }
    rested_             = 0;
    const double before = counts_, ratio = upwards / kArm;
    if (std::abs(ratio - 1) > kAlike) useCounts(counts_ * std::clamp(ratio, 1 / kStep, kStep));
    if (counts_ == before && isHeld && upwards > kLeast) start(FalconCalibrationStage::bare);
    if (counts_ == before && upwards > kMostForce) fail("the arm could not be carried: let nothing hang on the grip");
}

/// Uses other counts for the same motor numbers.
void FalconCalibration::useCounts(double counts) noexcept
{
    const double before = counts_;
    counts_             = std::clamp(counts, FalconMotors::kLeastCountsPerTorque, FalconMotors::kMostCountsPerTorque);
    integral_ *= before / counts_;
}

void FalconCalibration::endPeriod() noexcept
{
    means_[std::size_t(periods_++)] = sum_ / time_;
    time_ = sum_ = 0;
    if (periods_ < kPeriods) return;
    if (std::abs(means_[kPeriods - 1] - means_[kPeriods - 2]) > kSpread)
        return fail("the force did not settle: let go of the grip, and let nothing touch it");
    const double mean = (means_[kPeriods - 1] + means_[kPeriods - 2]) / 2;
    if (stage_ == FalconCalibrationStage::bare) {
        bare_ = mean;
        return start(FalconCalibrationStage::hang);
    }
    loaded_ = mean;
    if (loaded_ - bare_ < kLeast) return fail("no mass was felt: hang it on the grip when asked to");
    if (const double found = counts_ * (loaded_ - bare_) / (settings_.mass * settings_.gravity);
        found < FalconMotors::kLeastCountsPerTorque / (1 + kBeyond) ||
        found > FalconMotors::kMostCountsPerTorque * (1 + kBeyond))
        return fail("the counts per N m that were found are out of the bounds, as no Falcon's are: check the mass");
    if (settings_.mass * bare_ / (loaded_ - bare_) > kMostArm)
        return fail("the arm seems to weigh more than 400 g, as no Falcon's does: check the mass");
    stage_ = FalconCalibrationStage::done;
}

void FalconCalibration::hung() noexcept
{
    if (stage_ == FalconCalibrationStage::hang) start(FalconCalibrationStage::loaded);
}

void FalconCalibration::start(FalconCalibrationStage stage) noexcept
{
    if (stage != stage_) lifting_ = 0;
    stage_   = stage;
    rested_  = 0;
    periods_ = 0;
    time_ = sum_ = 0;
}

void FalconCalibration::fail(const char* why) noexcept
{
    stage_   = FalconCalibrationStage::failed;
    failure_ = why;
}

std::optional<double> FalconCalibration::countsPerTorque() const noexcept
{
    if (stage_ != FalconCalibrationStage::done) return {};
    return foundCountsPerTorque();
}

double FalconCalibration::foundCountsPerTorque() const noexcept
{
    return std::clamp(counts_ * (loaded_ - bare_) / (settings_.mass * settings_.gravity),
                      FalconMotors::kLeastCountsPerTorque, FalconMotors::kMostCountsPerTorque);
}

std::optional<double> FalconCalibration::armMass() const noexcept
{
    if (stage_ != FalconCalibrationStage::done) return {};
    return settings_.mass * bare_ / (loaded_ - bare_);
}

} // namespace palp
