#include "device/falcon/falcon_loop.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "device/falcon/falcon_driver.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kStale    = 10e-3; ///< [s] age of an answer from which on no force is sent: half the shortest hold
constexpr double kRise     = 20e-3; ///< [s] in which a force rises after a break, as long as the governor's fall
constexpr double kLongest  = 4e-3;  ///< [s] most time between two packets that is counted, as in the governor
constexpr double kBothWays = 2 * 16 * 10 / 1.5e6; ///< [s] 213 us: a packet and its answer on the wire

constexpr int    kMostMissed  = 20;    ///< see DeviceFault::silent
constexpr double kMostSilence = 0.1;   ///< [s] likewise
constexpr int    kGoodAgain   = 20;    ///< good answers after which a fault of the line is over
constexpr int    kPatience    = 4;     ///< misses after which a packet is sent only once per kPause
constexpr double kPause       = 10e-3; ///< [s] so that packets do not pile up in a stalled line

constexpr double kFastest = 4;    ///< [m/s] of a grip; the governor stops at 1.2
constexpr double kSlip    = 1e-3; ///< [m] at kFastest, because answers may follow each other faster than their packets
constexpr double kJump    = 5e-3; ///< [m] from one answer to the next, beyond which no velocity is computed
constexpr double kBlink   = 5e-3; ///< [s] after which a grip that is back in place does not prove the jump wrong
constexpr double kUsual   = 1.5;  ///< [m/s] of a grip that was in place all the time: just above the governor's limit

constexpr std::size_t kRead = 512; ///< [byte] at once

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x + v.y + v.z);
}

} // namespace

DeviceLight falconLight(const HapticState& state, std::uint8_t host) noexcept
{
    if (!state.homed) return DeviceLight::red;
    const bool flows = (host & std::uint8_t(DeviceLight::green)) != 0;
    return flows && state.fault == DeviceFault::none && state.inBox ? DeviceLight::green : DeviceLight::blue;
}

const char* meaningOf(DeviceLight light) noexcept
{
    switch (light) {
    case DeviceLight::red:
        return "red    it is to be homed";
    case DeviceLight::blue:
        return "blue   no force flows: no session, a hand that is awaited, a grip out of its workspace, or a fault";
    case DeviceLight::green:
        return "green  forces flow, or come on";
    default:
        return "none";
    }
}

FalconLoop::FalconLoop(std::unique_ptr<FalconLink> link, const FalconLoopSettings& settings)
    : link_(std::move(link)), settings_(settings), kinematics_(settings.geometry),
      motors_(kinematics_, settings.countsPerTorque), velocityFilter_(settings.velocityWindow)
{
    const auto demand = [](const char* what, double value, double least, double most) {
        if (!(value >= least && value <= most))
            throw Error("Falcon: " + std::string(what) + " must be from " + std::to_string(least) + " to " +
                        std::to_string(most) + ", found " + std::to_string(value));
    };
    demand("workspaceRadius", settings.workspaceRadius, 0.01, 0.044);
    demand("velocityWindow", settings.velocityWindow, 0, 0.1);
    demand("answerTimeout", settings.answerTimeout, 1e-3, 20e-3);
    sent_ = answered_ = link_->now();
    state_.fault      = DeviceFault::startingUp;
}

const HapticState& FalconLoop::exchange(const FalconRequest& request) noexcept
{
    if (isLost()) return state_;
    try {
        if (request.silent) {
            keepSilent();
            return state_;
        }
        if (request.countsPerTorque > 0) motors_.setCountsPerTorque(request.countsPerTorque);
        const double now = link_->now();
        state_.fault     = line_ != DeviceFault::none ? line_ : request.host;
        if (state_.fault == DeviceFault::none && inDoubt_ && now - placed_ > kBlink)
            state_.fault = DeviceFault::kinematics;
        const bool mustLetGo = now - answered_ >= kStale && command_.motors != FalconCommand{}.motors;
        if (state_.missed < kPatience || now - sent_ >= kPause || mustLetGo) send(request, now);

        bool         isAnswered = false;
        const double until      = now + settings_.answerTimeout;
        for (double left = until - now; left > 0; left = until - link_->now()) {
            isAnswered = collect(left) || isAnswered;
            if (isAnswered && link_->now() - sent_ >= kBothWays) break; // an earlier one answers another packet
        }
        if (!isAnswered) miss();
    } catch (const LinkGone&) {
        lose(Loss::gone);
    } catch (const std::exception&) { // any other LinkLost, or no memory for the link
        lose(Loss::broken);
    }
    return state_;
}

/// Passes a millisecond in which the device hears nothing.
void FalconLoop::keepSilent()
{
    link_->keepAlive();
    const double until = link_->now() + 1e-3;
    for (double left = 1e-3; left > 0; left = until - link_->now()) collect(left);
}

void FalconLoop::listen(double until) noexcept
{
    if (isLost()) return;
    try {
        for (double left = until - link_->now(); left > 0; left = until - link_->now()) collect(left);
    } catch (const LinkGone&) {
        lose(Loss::gone);
    } catch (const std::exception&) {
        lose(Loss::broken);
    }
}

FalconLoop::~FalconLoop()
{
    if (loss_ != Loss::gone) release();
}

/// \return false if the device is gone
bool FalconLoop::release() noexcept
{
    command_.homing = false;
    command_.lights = settings_.showsState ? std::uint8_t(DeviceLight::none) : command_.lights;
    return releaseMotors(*link_, command_);
}

void FalconLoop::send(const FalconRequest& request, double now)
{
    command_.motors = drive(request, now).motors;
    command_.homing = !state_.homed;
    command_.lights = settings_.showsState ? std::uint8_t(falconLight(state_, request.lights)) : request.lights;
    sent_           = now;
    link_->write(encode(command_));
    if (!link_->wasSilenced()) return;
    // What went out was zero. The fault makes the governor engage anew.
    line_ = state_.fault = DeviceFault::silenced;
    gain_ = good_ = 0;
}

FalconDrive FalconLoop::drive(const FalconRequest& request, double now) noexcept
{
    if (!isFinite(request.force) && state_.fault == DeviceFault::none) state_.fault = DeviceFault::badForce;
    const glm::dvec3 force = allowed(request, now);
    if (force == glm::dvec3(0)) return {};
    const FalconDrive made = motors_.drive(state_.position + FalconKinematics::kMiddle, force);
    if (made.badForce) state_.fault = DeviceFault::badForce;
    if (made.singular) state_.fault = DeviceFault::kinematics;
    if (made.badForce || made.singular) gain_ = 0;
    return made;
}

/// Returns the part of the wanted force that may act [N].
glm::dvec3 FalconLoop::allowed(const FalconRequest& request, double now) noexcept
{
    const bool isOpen =
        state_.fault == DeviceFault::none && state_.homed && state_.inBox && !inDoubt_ && now - answered_ < kStale;
    const double most = std::clamp(request.share, 0.0, 1.0);
    gain_             = isOpen ? std::min(most, gain_ + std::min(now - sent_, kLongest) / kRise) : 0;
    return isOpen ? gain_ * request.force : glm::dvec3(0);
}

/// Reads once; of several answers only the newest counts.
/// \return whether there was one that was believed
bool FalconLoop::collect(double timeout)
{
    std::array<std::uint8_t, kRead> bytes;
    parser_.feed(std::span(bytes).first(link_->read(bytes, timeout)));
    std::optional<FalconReply> newest;
    while (const auto reply = parser_.next()) newest = reply;
    return newest && accept(*newest);
}

bool FalconLoop::accept(const FalconReply& reply) noexcept
{
    const double now    = link_->now();
    const bool   isGood = reply.homed() && placeGrip(reply, now);
    disbelief_          = reply.homed() && !isGood && hasPlace_ && now - placed_ <= kBlink;
    if (disbelief_) return false;

    state_.homed   = reply.homed();
    state_.inBox   = isGood && glm::length(state_.position) <= settings_.workspaceRadius;
    state_.buttons = reply.grip;
    state_.time    = now;
    state_.age     = now - sent_; // the firmware measures when the packet has come, which is also when its force acts
    state_.missed  = 0;
    ++state_.sequence;
    answered_ = now;
    skipped_  = parser_.skipped();
    good_     = isGood || !reply.homed() ? good_ + 1 : 0;
    unsolved_ = isGood || !reply.homed() ? 0 : unsolved_ + 1;
    if (!isGood) state_.velocity = {};
    if (!isGood && hasPlace_ && state_.fault == DeviceFault::none) state_.fault = DeviceFault::kinematics;
    if (!reply.homed()) forgetPlace();
    if (unsolved_ > kMostMissed && line_ == DeviceFault::none) line_ = DeviceFault::kinematics;
    if (good_ >= kGoodAgain) line_ = DeviceFault::none;
    if (line_ != DeviceFault::none) state_.fault = line_;
    return true;
}

/// Updates position and velocity of a homed arm; both stay if there is no position that is believed.
bool FalconLoop::placeGrip(const FalconReply& reply, double now) noexcept
{
    const auto angles   = kinematics_.angles(reply.encoders);
    const auto position = kinematics_.position(angles, state_.position + FalconKinematics::kMiddle);
    if (!position) { // counts as a jump: this place does not exist
        inDoubt_ = hasPlace_;
        agreed_  = 0;
        return false;
    }
    const glm::dvec3 here = *position - FalconKinematics::kMiddle;
    if (hasPlace_ && !isCredible(here, now)) return false;
    if (!hasPlace_ || glm::length(here - state_.position) > kJump) velocityFilter_.restart();
    forgetPlace();
    velocityFilter_.add(now, here);
    state_.position = here;
    state_.velocity = velocityFilter_.velocity();
    placed_         = now;
    hasPlace_       = true;
    return true;
}

/// Returns whether a position is believed. The distance that the grip may have moved grows with time, but time alone
/// must not make a jump credible.
bool FalconLoop::isCredible(const glm::dvec3& here, double now) noexcept
{
    const double moved = glm::length(here - state_.position), since = now - placed_;
    if (!inDoubt_ && moved <= kSlip + kFastest * since) return true;
    if (inDoubt_ && since <= kBlink && moved <= kSlip + kUsual * since) return true;
    const double reach = kSlip + kFastest * std::min(now - seen_, kLongest);
    agreed_            = inDoubt_ && agreed_ > 0 && glm::length(here - elsewhere_) <= reach ? agreed_ + 1 : 1;
    inDoubt_           = true;
    elsewhere_         = here;
    seen_              = now;
    return agreed_ >= kGoodAgain;
}

/// Forgets the last position, so that the next one is believed wherever it is.
void FalconLoop::forgetPlace() noexcept
{
    hasPlace_ = inDoubt_ = false;
    agreed_              = 0;
}

void FalconLoop::miss() noexcept
{
    ++state_.missed;
    good_ = 0;
    if (state_.missed <= kMostMissed && link_->now() - answered_ <= kMostSilence) return;
    const bool isNonsense = disbelief_ || parser_.skipped() != skipped_;
    line_ = state_.fault = isNonsense ? DeviceFault::garbled : DeviceFault::silent;
    forgetPlace();
}

/// Handles a lost link. A device that is not certainly gone may still push, and may still receive.
void FalconLoop::lose(Loss loss) noexcept
{
    loss_ = loss == Loss::broken && !release() ? Loss::gone : loss;
    line_ = state_.fault = loss_ == Loss::gone ? DeviceFault::unplugged : DeviceFault::linkLost;
    state_.homed = state_.inBox = false;
    state_.velocity             = {};
    ++state_.missed;
}

} // namespace palp
