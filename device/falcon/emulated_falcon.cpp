#include "device/falcon/emulated_falcon.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "device/falcon/falcon_firmware.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kPiece = 1e-3; ///< [s] longest motion with one force: the torques' force turns with the pose

} // namespace

EmulatedFalcon::EmulatedFalcon(const EmulatedFalconSettings& settings, Arm arm)
    : settings_(settings), arm_(std::move(arm)), kinematics_(settings.geometry),
      motors_(kinematics_, settings.countsPerTorque)
{
    if (!(settings.holdTime > 0) || !(settings.answerTime >= 0))
        throw Error("emulated Falcon: holdTime must be above 0 and answerTime not below, found " +
                    std::to_string(settings.holdTime) + " and " + std::to_string(settings.answerTime) + " s");
    if (settings.running) stage_ = FalconStage::running;
    if (settings.running && settings.homed) homedLegs_ = 7;
    if (arm_) position_ = arm_(glm::dvec3(0), 0);
}

void EmulatedFalcon::setDtr(bool high) noexcept
{
    // The loader starts over; running firmware ignores this [I].
    if (high && !dtr_ && stage_ != FalconStage::running) {
        stage_ = FalconStage::hello;
        heard_ = {};
        image_.clear();
    }
    dtr_ = high;
}

void EmulatedFalcon::powerCycle()
{
    stage_     = FalconStage::asleep;
    homedLegs_ = wasOut_ = 0;
    command_             = {};
    filled_              = 0;
    image_.clear();
}

std::uint16_t EmulatedFalcon::divisor() const noexcept
{
    switch (stage_) {
    case FalconStage::running:
        return std::uint16_t(FalconDivisor::run);
    case FalconStage::loader:
    case FalconStage::greeted:
        return std::uint16_t(FalconDivisor::loader);
    default:
        return std::uint16_t(FalconDivisor::hello);
    }
}

std::span<const std::uint8_t> EmulatedFalcon::receive(std::uint8_t byte, std::uint16_t at, double time)
{
    moveTo(time);
    const bool isWhole = image_.size() >= kLeastFalconFirmware && image_.size() <= kMostFalconFirmware;
    if (stage_ == FalconStage::loader && at == std::uint16_t(FalconDivisor::run) && isWhole)
        stage_ = FalconStage::running;
    if (stage_ == FalconStage::greeted && at == std::uint16_t(FalconDivisor::hello)) stage_ = FalconStage::hello;
    if (at != divisor()) {
        if (stage_ != FalconStage::running) deaf_ = deaf_ || settings_.probingDeafens;
        return {};
    }
    if (stage_ == FalconStage::running) return run(byte, time);
    if (deaf_) return {};
    return stage_ == FalconStage::loader ? load(byte) : boot(byte);
}

std::span<const std::uint8_t> EmulatedFalcon::boot(std::uint8_t byte)
{
    std::rotate(heard_.begin(), heard_.begin() + 1, heard_.end());
    heard_.back() = byte;
    if (stage_ == FalconStage::hello && heard_ == std::array<std::uint8_t, 3>{0x0A, 0x43, 0x0D}) {
        stage_ = FalconStage::greeted;
        return say({0x0A, 0x44, 0x2C, 0x0D});
    }
    if (stage_ == FalconStage::greeted && !dtr_ && byte == 0x41) {
        stage_ = FalconStage::loader;
        return say({0x41});
    }
    return {};
}

std::span<const std::uint8_t> EmulatedFalcon::load(std::uint8_t byte)
{
    if (image_.size() <= kMostFalconFirmware) image_.push_back(byte);
    return say({byte});
}

std::span<const std::uint8_t> EmulatedFalcon::say(std::initializer_list<std::uint8_t> bytes)
{
    std::copy(bytes.begin(), bytes.end(), outgoing_.begin());
    return std::span(outgoing_).first(bytes.size());
}

std::span<const std::uint8_t> EmulatedFalcon::run(std::uint8_t byte, double time)
{
    if (byte == '<') filled_ = 0;
    if (filled_ == 0 && byte != '<') return {};
    incoming_[filled_++] = byte;
    if (filled_ < incoming_.size()) return {};
    filled_            = 0;
    const auto command = decodeCommand(incoming_);
    if (!command) return {};
    command_   = *command;
    commanded_ = time;
    ++packets_;
    outgoing_ = encode(reply());
    return outgoing_;
}

FalconReply EmulatedFalcon::reply()
{
    FalconReply answer;
    answer.grip       = grip_;
    const auto angles = kinematics_.angles(position_ + FalconKinematics::kMiddle);
    if (!angles) return answer; // the caller's arm left the workspace: encoders at 0, not homed
    const auto counts = kinematics_.counts(*angles);
    for (std::size_t leg = 0; leg < 3; ++leg) {
        const auto bit = std::uint8_t(1u << leg);
        if (counts[leg] >= settings_.outerStop && command_.homing) wasOut_ |= bit;
        if (counts[leg] <= settings_.innerStop && command_.homing && (wasOut_ & bit)) homedLegs_ |= bit;
        const long wrong     = homedLegs_ & bit ? 0 : settings_.offset[leg];
        answer.encoders[leg] = std::int16_t(std::lround(counts[leg]) + wrong);
    }
    answer.homedLegs = homedLegs_;
    return answer;
}

std::array<std::int16_t, 3> EmulatedFalcon::motors() const noexcept
{
    const bool holds = stage_ == FalconStage::running && commanded_ >= 0 && time_ < commanded_ + settings_.holdTime;
    return holds ? command_.motors : std::array<std::int16_t, 3>{};
}

glm::dvec3 EmulatedFalcon::force() const
{
    return kinematics_.force(position_ + FalconKinematics::kMiddle, motors_.torques(motors())).value_or(glm::dvec3(0));
}

void EmulatedFalcon::moveTo(double time)
{
    while (time_ < time) {
        double until = std::min(time, time_ + kPiece);
        // The arm moves with the motors until they let go, and then without them.
        const double limp = commanded_ + settings_.holdTime;
        if (commanded_ >= 0 && limp > time_) until = std::min(until, limp);
        const auto pushes = motors();
        if (arm_) position_ = arm_(force(), until - time_);
        time_ = until;
        if (pushes != std::array<std::int16_t, 3>{}) lastTorque_ = time_;
    }
}

} // namespace palp
