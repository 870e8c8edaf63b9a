#include "device/falcon/falcon_device.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "device/detail/held_force.h"
#include "engine/core/real_time.h"

namespace palp {
namespace {

constexpr double kMostWait = 0.1; ///< [s] by which a step follows the servo's clock; beyond it the clocks are set anew

/// Returns the weight of an arm [N], in the device's frame.
glm::dvec3 weightOf(double armMass)
{
    constexpr double kGravity = 9.81; // [m/s2]
    return {0, -armMass * kGravity, 0};
}

double seconds(std::chrono::steady_clock::duration duration)
{
    return std::chrono::duration<double>(duration).count();
}

} // namespace

FalconDevice::FalconDevice(FalconLinkOpener open, const FalconDeviceSettings& settings)
    : open_(std::move(open)), settings_(settings)
{
    info_.model            = "Novint Falcon";
    info_.path             = settings.path;
    info_.serial           = settings.serial;
    info_.workspaceRadius  = settings.loop.workspaceRadius;
    info_.maximumForce     = 8;    // CHAI3D's table; 4095 counts at 4200 hold 11.4 N at the worst place of the sphere
    info_.maximumStiffness = 1000; // half of where the released arm starts to swing, at 1 kHz and a tick of delay
    info_.maximumDamping   = 1.5;  // so that 1000 N/m (T/2 + delay) and it stay below the arm's own 3.2
    info_.mass             = 0.46; // one published measurement, as is the next
    info_.ownDamping       = 3.2;  // with the loss of sampling added back
    info_.buttons          = 4;
    info_.needsHoming      = true;
    info_.weight           = weightOf(settings.armMass);
}

void FalconDevice::open()
{
    if (line_) return;
    StartedFalcon      started = startFalcon(open_, settings_.firmware, settings_.start);
    FalconLoopSettings loop    = settings_.loop;
    if (settings_.tune) {
        info_.serial              = started.link->serial();
        const FalconTuning tuning = settings_.tune(info_.serial);
        loop.countsPerTorque      = tuning.countsPerTorque;
        info_.weight              = weightOf(tuning.armMass);
        info_.note                = tuning.note;
    }
    counts_   = loop.countsPerTorque;
    auto line = std::make_unique<Line>(std::make_unique<FalconLoop>(std::move(started.link), loop));
    if (settings_.pace == FalconPace::thread)
        line->thread = std::thread(converse, std::ref(*line), settings_.asksForRealTime);
    line_ = std::move(line);
}

void FalconDevice::close() noexcept
{
    if (!line_) return;
    line_->isOver = true;
    if (line_->thread.joinable()) line_->thread.join();
    line_.reset(); // its FalconLoop ends with zero force
}

void FalconDevice::render(const GovernedForce& force) noexcept
{
    if (!line_) return;
    line_->asked = {
        .force = force.newtons(), .lights = lights_, .silent = silentUntil_.has_value(), .countsPerTorque = counts_};
    if (settings_.pace == FalconPace::stepped) return;
    line_->requests.draft() = {line_->asked, Clock::now()};
    line_->requests.publish();
}

HapticState FalconDevice::read(double now) noexcept
{
    if (!line_) return {};
    if (stopsFor_ > 0) silentUntil_ = now + std::exchange(stopsFor_, 0);
    if (silentUntil_ && !(now < *silentUntil_)) silentUntil_.reset();
    line_->asked.silent = silentUntil_.has_value();
    return settings_.pace == FalconPace::stepped ? step(line_->asked, now) : newest(now);
}

void FalconDevice::useCounts(double counts) noexcept
{
    counts_ = std::clamp(counts, FalconMotors::kLeastCountsPerTorque, FalconMotors::kMostCountsPerTorque);
}

void FalconDevice::stopSending(double time) noexcept
{
    constexpr double kMost = 0.5; // [s]
    stopsFor_              = time > 0 ? std::min(time, kMost) : 0;
}

/// Runs the I/O thread: sends the newest force, and less of it the longer the servo does not call.
void FalconDevice::converse(Line& line, bool asksForRealTime) noexcept
{
    // A refusal is not reported: the servo has asked before and reported it.
    if (asksForRealTime) static_cast<void>(askForRealTime());
    while (!line.isOver && !line.loop->isLost()) {
        line.requests.take();
        FalconRequest request;
        if (const TimedRequest* asked = line.requests.held()) {
            const double age = seconds(Clock::now() - asked->time);
            request          = asked->request;
            request.share    = heldShare(age);
            if (age > kHostTooSlow) request.host = DeviceFault::hostTooSlow;
            request.silent = request.silent && age < kForceHold; // a servo that hangs asks for no silence
        }
        const HapticState& state = line.loop->exchange(request);
        line.answers.draft()     = {state, Clock::now(), line.loop->now() - state.time};
        line.answers.publish();
    }
}

HapticState FalconDevice::newest(double now) noexcept
{
    line_->answers.take();
    const Answer* answer = line_->answers.held();
    HapticState   state;
    state.fault = DeviceFault::startingUp;
    if (!answer) return state;
    const double old = seconds(Clock::now() - answer->time);
    state            = answer->state;
    state.time       = now - old - answer->age;
    // The thread hangs in a write, or got no processor.
    if (state.fault == DeviceFault::none && old > kHostTooSlow) {
        state.fault = DeviceFault::silent;
        state.inBox = false;
    }
    return state;
}

/// Follows the servo's clock, which may start anew, then makes the round trip. For the servo no time passes meanwhile:
/// its position is as old as its packet.
HapticState FalconDevice::step(FalconRequest request, double now) noexcept
{
    FalconLoop&  loop   = *line_->loop;
    const double ahead  = now - line_->offset - loop.now();
    const bool   isEven = now >= line_->last && !line_->isFirst && ahead <= kMostWait;
    if (!line_->isFirst && !(now - line_->last <= kHostTooSlow)) request.host = DeviceFault::hostTooSlow;
    if (isEven)
        loop.listen(now - line_->offset);
    else if (std::isfinite(now))
        line_->offset = now - loop.now();
    line_->isFirst    = false;
    line_->last       = now;
    HapticState state = loop.exchange(request);
    state.time += line_->offset - state.age;
    state.age = 0;
    return state;
}

} // namespace palp
