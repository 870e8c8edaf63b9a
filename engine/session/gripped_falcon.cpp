#include "engine/session/gripped_falcon.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "device/falcon/falcon_record.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::array kOptions{kFalconFirmware, kFalconCounts, kFalconTimerOnly, kFalconCold};

constexpr std::size_t kStandInFirmware = 8000; ///< [byte] of zeros, which the emulator takes as well as any

/// Returns the values for the emulated Falcon: those of its calibration, which need not be quite true, else its own.
/// \throws Error as readFalconConstants()
FalconTuning tuningOfEmulated(std::optional<double> byHand)
{
    if (readFalconConstants(kEmulatedFalconSerial)) {
        FalconTuning tuning = tuningOf(kEmulatedFalconSerial, byHand);
        if (tuning.note.empty())
            tuning.note = "the emulated Falcon runs as its calibration found it: " +
                          falconConstantsFile(kEmulatedFalconSerial).string() + "; without this file it runs exactly";
        return tuning;
    }
    return {.countsPerTorque = byHand.value_or(FalconMotors::kCountsPerTorque), .armMass = emulatedFalconArm()};
}

/// Describes the calibration of the emulated Falcon, which needs none.
std::string calibration()
{
    try {
        if (!readFalconConstants(kEmulatedFalconSerial)) return {};
    } catch (const Error&) { // which is described, too
    }
    return describeConstants(kEmulatedFalconSerial);
}

std::unique_ptr<HapticDevice> make(const DeviceRequest& request)
{
    FalconDeviceSettings settings = falconSettings(request);
    settings.tune = [byHand = countsByHand(request.options)](const std::string&) { return tuningOfEmulated(byHand); };
    if (textOf(request.options, kFalconCold).empty()) {
        if (!textOf(request.options, kFalconFirmware).empty())
            throw Error(std::string(kFalconFirmware.flag) + ": an emulated Falcon needs it with " +
                        std::string(kFalconCold.flag) + " only");
        return std::make_unique<GrippedFalcon>(*request.hand, GrippedFalcon::ready(), settings);
    }
    settings.firmware = falconFirmware(request);
    if (settings.firmware.empty()) settings.firmware.assign(kStandInFirmware, 0);
    return std::make_unique<GrippedFalcon>(*request.hand, Ft232EmulatorSettings{.serial = kEmulatedFalconSerial},
                                           settings);
}

/// Returns where the hand that homes the Falcon has the grip along the device's z [m], by the time [s] since then: out,
/// in as far as it goes, and back to the middle. Empty once it has been there for a moment.
std::optional<double> homingPlace(double time)
{
    constexpr double kOut = 0.048, kIn = -0.052, kSpeed = 0.1, kRest = 0.3; // [m], [m/s], [s]
    constexpr double kTurn = kOut / kSpeed + kRest, kBack = kTurn + (kOut - kIn) / kSpeed + kRest;
    if (time < kTurn) return std::min(kOut, kSpeed * time);
    if (time < kBack) return std::max(kIn, kOut - kSpeed * (time - kTurn));
    if (time < kBack - kIn / kSpeed + kRest) return std::min(0.0, kIn + kSpeed * (time - kBack));
    return {};
}

/// Returns the settings of an arm alone: the emulator has the encoders, the delays and the stops.
SimulatedArmSettings bareArm()
{
    SimulatedArmSettings arm = fallingArm();
    arm.encoderStep          = 0;
    arm.delayTicks           = 0;
    return arm;
}

const glm::dvec3 kWeight = bareArm().weight; ///< [N]

FalconDeviceSettings stepped(FalconDeviceSettings settings)
{
    settings.pace = FalconPace::stepped;
    return settings;
}

} // namespace

const DeviceRecord kFalconEmulatorRecord{.name        = "falcon-emulator",
                                         .model       = "a Falcon emulated down to its wire, in a scripted hand",
                                         .holder      = DeviceHolder::scriptedHand,
                                         .simulated   = true,
                                         .options     = kOptions,
                                         .make        = make,
                                         .calibration = calibration};

double emulatedFalconArm()
{
    constexpr double kGravity = 9.81; // [m/s2]
    return -kWeight.y / kGravity;
}

Ft232EmulatorSettings GrippedFalcon::ready()
{
    Ft232EmulatorSettings settings;
    settings.falcon.running = settings.falcon.homed = true;
    settings.serial                                 = kEmulatedFalconSerial;
    return settings;
}

GrippedFalcon::GrippedFalcon(const GrippingHand& hand, const Ft232EmulatorSettings& falcon,
                             const FalconDeviceSettings& device)
    : hand_(hand), arm_(bareArm(), hand.at(0).target),
      emulator_(falcon, [this](const glm::dvec3& force, double dt) { return moved(force, dt); }),
      device_([this] { return emulator_.connect(); }, stepped(device)), isTuned_(device.tune != nullptr),
      info_(device_.info())
{
    hand.demandWithin(info_.workspaceRadius);
    info_.model        = "emulated Falcon";
    info_.isSimulation = true;
    info_.needsHoming  = !falcon.falcon.homed;
    info_.serial       = falcon.serial;
    info_.weight       = kWeight; // as after a calibration
}

void GrippedFalcon::open()
{
    device_.open();
    if (!isTuned_) return;
    info_.weight = device_.info().weight;
    info_.note   = device_.info().note;
}

HapticState GrippedFalcon::read(double now) noexcept
{
    if (!running_ || now < last_) { // the servo's clock starts, or starts again
        begun_  = emulator_.now() - now;
        waited_ = 0;
    }
    running_ = true;
    last_    = now;
    if (const std::uint32_t wanted = hand_.path.buttons(hand_.path.begin() + now - waited_); wanted != pressed_) {
        emulator_.falcon().press(std::uint8_t(wanted));
        pressed_ = wanted;
    }
    return device_.read(now);
}

/// Returns the hand now, on its path or off it to home the Falcon.
SimulatedHand GrippedFalcon::handNow()
{
    if (homingSince_) {
        if (const auto place = homingPlace(emulated_ - *homingSince_)) {
            SimulatedHand hand  = hand_.at(0, kWeight);
            hand.target         = hand.target - hand_.at(0).target + glm::dvec3(0, 0, *place); // it carries the arm
            hand.targetVelocity = {};
            return hand;
        }
        homingSince_.reset();
        waited_ = emulated_ - begun_;
    }
    return hand_.at(running_ ? std::max(0.0, emulated_ - begun_ - waited_) : 0, kWeight);
}

glm::dvec3 GrippedFalcon::moved(const glm::dvec3& force, double dt)
{
    arm_.holdBy(handNow());
    emulated_ += dt;
    arm_.step(force, dt);
    return arm_.position();
}

} // namespace palp
