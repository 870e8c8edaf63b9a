#include "device/hid/hid_bridge.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "device/detail/held_force.h"
#include "device/detail/setting_range.h"
#include "engine/core/contract.h"
#include "engine/core/real_time.h"

namespace palp {
namespace {

constexpr double kSilence = 0.1;  // [s] without an answer, see DeviceFault::silent
constexpr int    kMissed  = 20;   // reads without an answer, after which no force is asked for; as the governor has it
constexpr double kQuiet   = 0.02; // [s] between zero commands while render() is not called: far from flooding
constexpr double kStep    = 1e-3; // [s] at least between commands while a force falls
constexpr double kLongest = 4e-3; // [s] most time between two commands that is counted, as in the governor
constexpr int    kZeros   = 3;    // commands at the end: one packet may be lost, hardly three
constexpr double kSilencedTime = 0.1; // [s] of DeviceFault::silenced: the governor must see it, to engage anew
constexpr int    kRestart = 20; // answers that count on from an old number before the device is taken to have restarted
constexpr int    kMostReports = 64;   // per pass, so that a flooded host still writes
constexpr double kFrames      = 1e-3; // [s] that USB holds a report and a command back: on average half a frame each
constexpr double kUsualBehind =
    5e-3; // [s] of the command that a device renders behind the newest: a way there and back
constexpr double kMostBehind = 25e-3; // [s] as long as a guardian waits; more, and forces are old or another program's
constexpr double kFarOut     = 2;     // [1] times the workspace's radius: no arm reaches that far

double secondsSince(std::chrono::steady_clock::time_point then)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

bool isFinite(const glm::dvec3& v) noexcept
{
    return std::isfinite(v.x + v.y + v.z);
}

} // namespace

bool isBridge(const HidListing& listing) noexcept
{
    return listing.usagePage == kBridgeUsagePage && listing.usage == kBridgeUsage;
}

HidBridgeDevice::HidBridgeDevice(HidSystem& system, const HidListing& listing, const HidBridgeSettings& settings)
    : system_(system), listing_(listing), settings_(settings)
{
    demandRange("HID bridge", "watchdog", settings.watchdog, 2e-3, 0.255);
    demandRange("HID bridge", "openWait", settings.openWait, 0, 60);
    demandRange("HID bridge", "readWait", settings.readWait, 0, 0.05);
    info_.model  = listing.model.empty() ? "HID bridge" : listing.model;
    info_.path   = listing.path;
    info_.serial = listing.serial;
}

HidBridgeDevice::~HidBridgeDevice()
{
    close();
}

void HidBridgeDevice::open()
{
    if (open_) return;
    port_ = system_.open(listing_.path);
    port_->guard(kBridgeZero);
    seen_         = {};
    wrongVersion_ = false;
    goesOn_       = 0;
    sent_         = 0;
    hot_          = false;
    isEchoed_     = false;
    written_      = 0;
    homing_       = false;
    offAt_        = 0;
    isBehind_     = false;
    wanted_       = {};
    started_ = stopped_ = impossible_ = false;
    seenGood_ = seenGarbled_ = seenSilenced_ = 0;
    silencedUntil_                           = 0;
    state_                                   = {};
    readsWithout_                            = 0;
    outbox_.take(); // commands of an earlier opening are discarded

    const auto deadline = Clock::now() + std::chrono::duration<double>(settings_.openWait);
    try {
        send({}); // zero, before anything else
        do receive(settings_.readWait);
        while (seen_.good == 0 && !wrongVersion_ && Clock::now() < deadline);
    } catch (const HidLost& lost) {
        port_.reset();
        throw Error(info_.model + " went away while it was opened: " + lost.what());
    }
    if (seen_.good == 0) {
        port_.reset();
        throw Error(info_.model + " (" + listing_.path + ") " +
                    (wrongVersion_
                         ? "speaks another version of the bridge's report than " + std::to_string(kBridgeMajor)
                         : "sends no report of a bridge") +
                    "; see device/README.md, \"The bridge\"");
    }
    describe(seen_.answer);
    open_        = true;
    state_.fault = DeviceFault::none;
    share_       = 1;
    lastAsked_ = lastSent_ = Clock::now();
    inbox_.draft()         = seen_;
    inbox_.publish();
    if (settings_.pace == HidPace::thread) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void HidBridgeDevice::describe(const BridgeAnswer& answer)
{
    info_.workspaceRadius  = answer.workspaceRadius;
    info_.maximumForce     = answer.maximumForce;
    info_.maximumStiffness = answer.maximumStiffness;
    info_.maximumDamping   = answer.maximumDamping;
    info_.ownDamping       = answer.ownDamping;
    info_.buttons          = answer.buttonCount;
    info_.needsHoming      = answer.has(BridgeFlag::needsHoming);
    info_.rotates          = answer.has(BridgeFlag::rotates);
    info_.hasGripper       = answer.has(BridgeFlag::grips);
}

void HidBridgeDevice::close() noexcept
{
    if (thread_.joinable()) { // it sends zero at its end
        thread_.request_stop();
        thread_.join();
    } else if (open_) {
        sayZero();
    }
    port_.reset();
    open_           = false;
    state_.fault    = DeviceFault::closed;
    state_.velocity = {};
}

// --- the port: the thread's, or read()'s

/// Reads every waiting report.
/// \throws HidLost if the device went away
void HidBridgeDevice::receive(double wait)
{
    std::array<std::uint8_t, kBridgeSize + 1> report{}; // one byte more, so that a report that is too long is noticed
    for (int n = 0; n < kMostReports; ++n) {
        const std::size_t size = port_->read(report, n == 0 ? wait : 0);
        if (size == 0) return;
        BridgeAnswer        answer;
        const BridgeVerdict verdict = decode(std::span(report).first(size), answer);
        wrongVersion_               = wrongVersion_ || verdict == BridgeVerdict::otherVersion;
        if (verdict == BridgeVerdict::good)
            takeAnswer(answer);
        else
            ++seen_.garbled;
    }
}

/// Takes an answer that is newer than the last one, by numbers that wrap around. A device that counts on from an old
/// number has restarted.
void HidBridgeDevice::takeAnswer(const BridgeAnswer& answer) noexcept
{
    const auto ahead = std::int16_t(answer.sequence - seen_.answer.sequence);
    if (seen_.good > 0 && ahead <= 0) {
        goesOn_      = std::int16_t(answer.sequence - lastRefused_) > 0 ? goesOn_ + 1 : 0;
        lastRefused_ = answer.sequence;
        if (goesOn_ < kRestart) return;
    }
    goesOn_      = 0;
    seen_.answer = answer;
    seen_.time   = Clock::now();
    seen_.behind = behind(answer.command);
    ++seen_.good;
}

/// Returns by how much the command of that number is older than the newest that was sent [s]; infinity if it is none of
/// the last, as where another program drives the device. A device that never told the number of ours is not judged.
double HidBridgeDevice::behind(std::uint16_t command) noexcept
{
    const bool isOurs = std::uint16_t(sent_ - command) < std::min(written_, sentAt_.size());
    isEchoed_         = isEchoed_ || isOurs;
    if (!isEchoed_) return 0;
    return isOurs ? std::chrono::duration<double>(lastSent_ - sentAt_[command % sentAt_.size()]).count() : HUGE_VAL;
}

/// \throws HidLost if the device went away
void HidBridgeDevice::send(BridgeCommand command)
{
    command.sequence                = ++sent_;
    command.watchdog                = settings_.watchdog;
    hot_                            = command.enable;
    lastSent_                       = Clock::now();
    sentAt_[sent_ % sentAt_.size()] = lastSent_;
    port_->write(encode(command));
    ++written_;
    if (!port_->wasSilenced()) return;
    sent_ = std::uint16_t(sent_ + kBridgeZeroAhead); // the guardian's zeros have counted ahead
    ++seen_.silenced;
}

void HidBridgeDevice::sendNewest()
{
    if (!outbox_.take()) return;
    lastAsked_ = outbox_.held()->time;
    sendShare(1);
}

/// Returns the part of the last requested force that may be sent; after a reduction it rises gradually.
void HidBridgeDevice::sendShare(double most)
{
    BridgeCommand command = outbox_.held()->command;
    const double  rise    = std::min(secondsSince(lastSent_), kLongest) / kForceFall;
    share_                = std::min(most, share_ + rise);
    command.force *= share_;
    command.enable = command.enable && share_ > 0;
    send(command);
}

/// Sends commands while render() is not called: a falling force, then zero repeatedly.
void HidBridgeDevice::letFall()
{
    const double age = secondsSince(lastAsked_), share = heldShare(age);
    if (hot_ && share < 1) {
        if (share == 0 || secondsSince(lastSent_) >= kStep) sendShare(share);
    } else if (share == 0 && secondsSince(lastSent_) > kQuiet) {
        send({});
    }
}

/// Reads, then writes.
/// \return false if the device is gone
bool HidBridgeDevice::readAndWrite(double wait) noexcept
{
    try {
        receive(wait);
        sendNewest();
        if (settings_.pace == HidPace::thread) letFall();
    } catch (const HidLost&) {
        seen_.lost = true;
    }
    inbox_.draft() = seen_;
    inbox_.publish();
    return !seen_.lost;
}

void HidBridgeDevice::run(const std::stop_token& stop) noexcept
{
    // A refusal is not reported: the servo has asked before and reported it.
    if (settings_.asksForRealTime) static_cast<void>(askForRealTime());
    while (!stop.stop_requested() && readAndWrite(settings_.readWait)) {
    }
    sayZero();
}

/// Says that there is no force, also where the device is taken as gone: perhaps only its guardian is.
void HidBridgeDevice::sayZero() noexcept
{
    for (int n = 0; n < kZeros; ++n) {
        try {
            send({});
        } catch (const HidLost&) {
            // That the guardian has ended stops one report. A device that has gone is stopped by its own watchdog.
            if (std::exchange(seen_.lost, true)) return;
        }
    }
}

// --- read() and render()

HapticState HidBridgeDevice::read(double now) noexcept
{
    if (!open_ || state_.fault == DeviceFault::unplugged) return state_;
    const bool own = settings_.pace == HidPace::caller;
    if (own) readAndWrite(0);
    followClock(now);
    readInbox(now);
    state_.fault = faultAt(now);
    started_     = true;
    lastRead_    = now;
    if (!own) return state_;
    command();
    try {
        sendNewest();
    } catch (const HidLost&) {
        seen_.lost = true; // seen by the next read()
    }
    return state_;
}

void HidBridgeDevice::render(const GovernedForce& force) noexcept
{
    wanted_ = force.newtons();
    if (open_ && settings_.pace == HidPace::thread) command();
}

/// Leaves a command with the wanted force for whoever sends.
void HidBridgeDevice::command() noexcept
{
    BridgeCommand& command = outbox_.draft().command;
    outbox_.draft()        = {{}, Clock::now()};
    command.enable = state_.fault == DeviceFault::none && isFinite(wanted_) && state_.homed && info_.maximumForce > 0;
    command.force  = command.enable ? renderable(wanted_) : glm::dvec3(0);
    if (!command.enable) offAt_ = lastRead_;
    command.home   = homing_ && !state_.homed;
    command.lights = lights_;
    outbox_.publish();
}

/// Follows a servo's clock that starts anew: all times move back with it.
void HidBridgeDevice::followClock(double now) noexcept
{
    if (!started_ || !(now < lastRead_)) return;
    const double back = lastRead_ - now;
    lastRead_ -= back;
    lastAnswer_ -= back;
    offAt_ -= back;
    silencedUntil_ -= back;
    state_.time -= back;
}

/// Takes the newest answer, if there is one.
void HidBridgeDevice::readInbox(double now) noexcept
{
    inbox_.take();
    const Inbox& inbox = *inbox_.held(); // open() has filled it
    if (inbox.lost) {
        state_.fault = DeviceFault::unplugged;
        return;
    }
    if (inbox.silenced != seenSilenced_) silencedUntil_ = now + kSilencedTime;
    seenSilenced_ = inbox.silenced;
    if (!started_) lastAnswer_ = now; // silence before the first read() does not count
    if (inbox.good == seenGood_) {
        // The governor stops for good where more than kMissed are missed: after kSilence, not after a pause of the
        // system.
        ++readsWithout_;
        state_.missed = std::min(readsWithout_, int(kMissed * std::clamp((now - lastAnswer_) / kSilence, 0.0, 2.0)));
        return;
    }
    const BridgeAnswer& answer = inbox.answer;
    seenGood_                  = inbox.good;
    seenGarbled_               = inbox.garbled;
    lastAnswer_                = now;
    state_.missed              = 0;
    readsWithout_              = 0;
    state_.sequence            = inbox.good;
    state_.time                = settings_.pace == HidPace::thread ? now - secondsSince(inbox.time) : now;
    state_.age                 = kFrames + std::clamp(inbox.behind - kUsualBehind, 0.0, kMostBehind);
    isBehind_                  = inbox.behind > kMostBehind && (isBehind_ || now - offAt_ > 2 * kMostBehind);
    stopped_                   = answer.has(BridgeFlag::stopped);
    state_.homed               = answer.has(BridgeFlag::homed);
    impossible_                = glm::length(answer.position) > kFarOut * answer.workspaceRadius;
    state_.inBox               = answer.has(BridgeFlag::inBox) && !impossible_;
    state_.buttons             = answer.buttons;
    state_.gripperAngle        = answer.gripper;
    state_.orientation         = answer.orientation;
    if (impossible_) return; // the hand stays at its last valid position
    state_.position = answer.position;
    state_.velocity = answer.velocity;
}

DeviceFault HidBridgeDevice::faultAt(double now) const noexcept
{
    if (state_.fault == DeviceFault::unplugged) return DeviceFault::unplugged;
    if (readsWithout_ > kMissed || now - lastAnswer_ > kSilence)
        return inbox_.held()->garbled != seenGarbled_ ? DeviceFault::garbled : DeviceFault::silent;
    if (now < silencedUntil_) return DeviceFault::silenced;
    if (impossible_) return DeviceFault::kinematics;
    if (stopped_ || isBehind_) return DeviceFault::ownWatchdog;
    if (!isFinite(wanted_)) return DeviceFault::badForce;
    if (started_ && now - lastRead_ > kHostTooSlow) return DeviceFault::hostTooSlow;
    return DeviceFault::none;
}

/// Limits a force to what the motors hold, in the same direction: limiting each field alone would turn the force.
glm::dvec3 HidBridgeDevice::renderable(const glm::dvec3& force) const noexcept
{
    const double size = glm::length(force);
    return size > info_.maximumForce ? force * (info_.maximumForce / size) : force;
}

} // namespace palp
