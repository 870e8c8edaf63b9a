#include "device/falcon/falcon_calibration.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "device/detail/setting_range.h"

namespace palp {
namespace {

constexpr double      kStroke    = 8e-3; ///< [m] each way: some hundred counts, and wider than static friction
constexpr double      kPeriod    = 4;    ///< [s] 13 mm/s at most
constexpr double      kStiffness = 300;  ///< [N/m] a third of what the loop holds; the arm's own damping suffices
constexpr double      kIntegral  = 300;  ///< [N/(m s)] the weight is found with a time constant of a second
constexpr double      kMostForce = 5.7;  ///< [N] below the governor's 6, beyond which a mean is meaningless
constexpr double      kLeast     = 0.1;  ///< [N] least weight of the mass
constexpr double      kSpread    = 0.05; ///< [N] most difference of the two measured periods; a touch causes more
constexpr const char* kTooHeavy  = "arm and mass could not be held: take a lighter mass";

} // namespace

FalconCalibration::FalconCalibration(const FalconCalibrationSettings& settings) : settings_(settings)
{
    demandRange("calibration", "mass", settings.mass, 0.05, 0.5);
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
        if (stage_ == Stage::bare) start(stage_);
        return {};
    }
    const bool   isWeighing = gain >= 1 && stage_ != Stage::hang;
    const double lift       = isWeighing ? kStroke * std::sin(2 * std::numbers::pi * time_ / kPeriod) : 0;
    const auto   away       = state.position - (anchor_ + lift * settings_.up);
    integral_ -= kIntegral * dt * away;
    if (isWeighing) {
        const double upwards = glm::dot(sent.newtons(), settings_.up);
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
    if (const double found = foundCountsPerTorque();
        found < FalconMotors::kLeastCountsPerTorque || found > FalconMotors::kMostCountsPerTorque)
        return fail("the counts per N m that were found are out of the bounds, as no Falcon's are: check the mass");
    stage_ = FalconCalibrationStage::done;
}

void FalconCalibration::hung() noexcept
{
    if (stage_ == FalconCalibrationStage::hang) start(FalconCalibrationStage::loaded);
}

void FalconCalibration::start(FalconCalibrationStage stage) noexcept
{
    stage_   = stage;
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
    return settings_.countsPerTorque * (loaded_ - bare_) / (settings_.mass * settings_.gravity);
}

std::optional<double> FalconCalibration::armMass() const noexcept
{
    if (stage_ != FalconCalibrationStage::done) return {};
    return settings_.mass * bare_ / (loaded_ - bare_);
}

} // namespace palp
