#include "device/line_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "device/detail/held_force.h"
#include "device/detail/setting_range.h"
#include "engine/core/real_time.h"

namespace palp {
namespace {

constexpr double kStale      = 10e-3; ///< [s] age of a sample from which on no force is sent, as of a Falcon
constexpr int    kStaleTurns = 10;    ///< the same in exchanges, where no clock runs between them
constexpr double kSilence    = 0.1;   ///< [s] without a sample, see DeviceFault::silent
constexpr int    kMissed  = 20;   ///< reads without a sample, after which no force is asked for; as the governor has it
constexpr double kLongest = 4e-3; ///< [s] most time between two exchanges that is counted, as in the governor
constexpr double kStep    = 1e-3; ///< [s] of virtual time from exchange to exchange
constexpr double kSilencedTime = 0.1; ///< [s] of DeviceFault::silenced: the governor must see it, to engage anew
constexpr double kFarOut       = 2;   ///< [1] times the workspace's radius: no arm reaches that far
constexpr double kTooFast      = 100; ///< [m/s] no velocity of a hand

double secondsSince(std::chrono::steady_clock::time_point then)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

bool isFinite(const glm::dvec3& v) noexcept
{
    return std::isfinite(v.x + v.y + v.z);
}

bool isTurn(const glm::dquat& q) noexcept
{
    const double size = glm::dot(q, q);
    return size > 0.98 && size < 1.02; // false for NaN
}

/// Returns whether a sample can be one of a hand; the place itself is judged by read().
bool isCredible(const LineSample& sample) noexcept
{
    return isFinite(sample.position) && isFinite(sample.velocity) && isFinite(sample.angularVelocity) &&
           std::isfinite(sample.gripperAngle) && isTurn(sample.orientation) &&
           std::max({std::abs(sample.velocity.x), std::abs(sample.velocity.y), std::abs(sample.velocity.z)}) < kTooFast;
}

} // namespace

LineDevice::LineDevice(std::unique_ptr<DeviceLine> line, HapticDeviceInfo info, const LineSettings& settings)
    : line_(std::move(line)), settings_(settings), known_(std::move(info)), info_(known_)
{
    demandRange("device", "leastPeriod", settings.leastPeriod, 0, 10e-3);
}

LineDevice::~LineDevice()
{
    close();
}

void LineDevice::open()
{
    if (open_) return;
    info_ = known_;
    line_->open(info_);
    seen_         = {};
    share_        = 0;
    empty_        = 0;
    lastTurn_     = Clock::now();
    wanted_       = {};
    words_        = "";
    state_        = {};
    readsWithout_ = 0;
    state_.fault  = DeviceFault::startingUp;
    started_ = impossible_ = false;
    seenGood_ = seenGarbled_ = seenSilenced_ = 0;
    silencedUntil_ = lastSample_ = lastRead_ = 0;
    outbox_.take(); // orders and samples of an earlier opening are discarded
    outbox_.draft() = {{}, Clock::now()};
    outbox_.publish();
    inbox_.draft() = seen_;
    inbox_.publish();
    open_ = true;
    if (settings_.pace == LinePace::caller) return;
    try {
        if (line_->drive([this] { turn(true); })) return;
    } catch (...) { // the line is closed
        open_        = false;
        state_.fault = DeviceFault::closed;
        throw;
    }
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void LineDevice::close() noexcept
{
    if (!open_) return;
    if (thread_.joinable()) {
        thread_.request_stop();
        thread_.join();
    }
    line_->close();
    open_           = false;
    state_.fault    = DeviceFault::closed;
    state_.velocity = {};
}

// --- the line: of the thread, of the line's own thread, or of read()

void LineDevice::run(const std::stop_token& stop) noexcept
{
    // A refusal is not reported: the servo has asked before and reported it.
    if (settings_.asksForRealTime) static_cast<void>(askForRealTime());
    while (!stop.stop_requested() && !isFinal(seen_.sample.fault)) {
        const auto next = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                             std::chrono::duration<double>(settings_.leastPeriod));
        turn(true);
        std::this_thread::sleep_until(next);
    }
}

/// Makes one exchange.
/// \param holds  the force falls with the age of its order; false: no clock runs between two exchanges
void LineDevice::turn(bool holds) noexcept
{
    if (isFinal(seen_.sample.fault)) return;
    const LineOrder order = allowed(holds);
    seen_.sample.news     = LineNews::none;
    LineSample sample     = seen_.sample;
    line_->exchange(order, sample);
    if (sample.news == LineNews::sample && !isCredible(sample)) sample.news = LineNews::garbled;
    empty_ = sample.news == LineNews::sample ? 0 : empty_ + 1;
    if (sample.news == LineNews::sample) {
        seen_.sample = sample;
        seen_.time   = Clock::now();
        ++seen_.good;
    } else { // the hand stays where it was
        seen_.garbled += sample.news == LineNews::garbled ? 1U : 0U;
        seen_.sample.fault    = sample.fault;
        seen_.sample.words    = sample.words;
        seen_.sample.silenced = sample.silenced;
    }
    inbox_.draft() = seen_;
    inbox_.publish();
}

/// Returns the part of the newest order that may act now; after a reduction it rises gradually.
LineOrder LineDevice::allowed(bool holds) noexcept
{
    outbox_.take();
    LineOrder    order = outbox_.held()->order; // open() has filled it
    const double most  = holds ? heldShare(secondsSince(outbox_.held()->time)) : 1;
    const bool   stale = holds ? secondsSince(seen_.time) > kStale : empty_ > kStaleTurns;
    const double past  = holds ? std::min(secondsSince(lastTurn_), kLongest) : kStep;
    lastTurn_          = Clock::now();
    const bool isOpen  = order.enable && seen_.good > 0 && !stale && seen_.sample.fault == DeviceFault::none;
    share_             = isOpen ? std::min(most, share_ + past / kForceFall) : 0;
    order.enable       = share_ > 0;
    order.force        = order.enable ? share_ * order.force : glm::dvec3(0);
    return order;
}

// --- read() and render()

HapticState LineDevice::read(double now) noexcept
{
    if (!open_ || isFinal(state_.fault)) return state_;
    if (settings_.pace == LinePace::caller) {
        order();
        turn(false);
    }
    followClock(now);
    readInbox(now);
    state_.fault = faultAt(now);
    if (state_.fault != DeviceFault::none && state_.fault != DeviceFault::startingUp)
        words_ = inbox_.held()->sample.words;
    started_  = true;
    lastRead_ = now;
    return state_;
}

void LineDevice::render(const GovernedForce& force) noexcept
{
    wanted_ = force.newtons();
    if (open_ && settings_.pace == LinePace::thread) order();
}

bool LineDevice::mayPush() const noexcept
{
    return state_.fault == DeviceFault::none && state_.homed && info_.maximumForce > 0 && isFinite(wanted_);
}

/// Leaves an order with the wanted force for whoever makes the exchanges. Its size is limited to what the motors hold;
/// its direction stays.
void LineDevice::order() noexcept
{
    LineOrder&   order = outbox_.draft().order;
    const double size  = glm::length(wanted_);
    outbox_.draft()    = {{}, Clock::now()};
    order.enable       = mayPush();
    if (order.enable) order.force = size > info_.maximumForce ? wanted_ * (info_.maximumForce / size) : wanted_;
    order.lights = lights_;
    outbox_.publish();
}

/// Follows a servo's clock that starts anew: all times move back with it.
void LineDevice::followClock(double now) noexcept
{
    if (!started_ || !(now < lastRead_)) return;
    const double back = lastRead_ - now;
    lastRead_ -= back;
    lastSample_ -= back;
    silencedUntil_ -= back;
    state_.time -= back;
}

/// Takes the newest sample, if there is one.
void LineDevice::readInbox(double now) noexcept
{
    inbox_.take();
    const Inbox&      inbox  = *inbox_.held(); // open() has filled it
    const LineSample& sample = inbox.sample;
    if (sample.silenced != seenSilenced_) silencedUntil_ = now + kSilencedTime;
    seenSilenced_ = sample.silenced;
    if (!started_) lastSample_ = now; // silence before the first read() does not count
    if (inbox.good == seenGood_) {
        // The governor stops for good where more than kMissed are missed: after kSilence, not after a pause of the
        // system.
        ++readsWithout_;
        state_.missed = std::min(readsWithout_, int(kMissed * std::clamp((now - lastSample_) / kSilence, 0.0, 2.0)));
        return;
    }
    seenGood_              = inbox.good;
    seenGarbled_           = inbox.garbled;
    lastSample_            = now;
    state_.missed          = 0;
    readsWithout_          = 0;
    state_.sequence        = inbox.good;
    state_.time            = settings_.pace == LinePace::thread ? now - secondsSince(inbox.time) : now;
    state_.age             = sample.age;
    state_.homed           = sample.homed;
    state_.buttons         = sample.buttons;
    state_.gripperAngle    = sample.gripperAngle;
    state_.orientation     = sample.orientation;
    state_.angularVelocity = sample.angularVelocity;
    impossible_            = glm::length(sample.position) > kFarOut * info_.workspaceRadius;
    state_.inBox           = glm::length(sample.position) <= info_.workspaceRadius;
    if (impossible_) return; // the hand stays at its last valid position
    state_.position = sample.position;
    state_.velocity = sample.velocity;
}

DeviceFault LineDevice::faultAt(double now) const noexcept
{
    const Inbox& inbox = *inbox_.held();
    if (isFinal(inbox.sample.fault)) return inbox.sample.fault;
    if (readsWithout_ > kMissed || !(now - lastSample_ <= kSilence))
        return inbox.garbled != seenGarbled_ ? DeviceFault::garbled : DeviceFault::silent;
    if (seenGood_ == 0) return DeviceFault::startingUp;
    if (now < silencedUntil_) return DeviceFault::silenced;
    if (impossible_) return DeviceFault::kinematics;
    if (inbox.sample.fault != DeviceFault::none) return inbox.sample.fault;
    if (!isFinite(wanted_)) return DeviceFault::badForce;
    if (started_ && now - lastRead_ > kHostTooSlow) return DeviceFault::hostTooSlow;
    return DeviceFault::none;
}

} // namespace palp
