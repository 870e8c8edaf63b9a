#include "device/haply/haply_line.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kGiveUp    = 20e-3; ///< [s] after which an answer is no longer awaited, and the next request leaves
constexpr double kLeastEcho = 0.05;  ///< [N] a force that the service must show
constexpr double kEchoShare = 0.1;   ///< [1] of it, at least: filters may lower it
constexpr int    kPatience  = 20;    ///< answers without it
constexpr int    kLater     = 200;   ///< the same, once forces were shown: a filter may hold one back for a moment
constexpr int    kAbsent    = 20;    ///< answers without the device, after which it is gone
constexpr int    kAtOnce    = 64;    ///< messages that are read before the next request
constexpr double kPause     = 0.1;   ///< [s] of a fault that the governor must see, to engage anew
constexpr double kStopped   = 0.5;   ///< [s] that an event of safety stops forces
constexpr double kForever   = 1e18;  ///< [s]
constexpr double kTry       = 0.1;   ///< [s] between attempts to find the device

std::span<const std::uint8_t> bytesOf(std::string_view text)
{
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Reads more of an answer.
/// \return false once the time is over [s] or the other side has closed
bool readMore(ByteLine& line, std::string& text, double until)
{
    std::array<std::uint8_t, 4096> bytes{};
    const double                   left = until - line.now();
    if (!(left > 0)) return false;
    try {
        const std::size_t got = line.read(bytes, left);
        text.append(bytes.begin(), bytes.begin() + std::ptrdiff_t(got));
    } catch (const LineEnded&) {
        return false;
    }
    return text.size() <= kMostWebSocketMessage;
}

/// The numbers are hexadecimal, and people write them as they like.
bool isSameId(std::string_view one, std::string_view other)
{
    const auto lower = [](unsigned char c) { return std::tolower(c); };
    return std::ranges::equal(one, other, {}, lower, lower);
}

std::string decimal(double value)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

} // namespace

// --- WebSocket

WebSocketClient::WebSocketClient(std::unique_ptr<ByteLine> line, const std::string& host, double timeout)
    : line_(std::move(line))
{
    std::random_device           source;
    std::array<std::uint8_t, 16> nonce{};
    for (std::uint8_t& byte : nonce) byte = std::uint8_t(source());
    random_               = std::uint64_t(source()) << 32U | source() | 1U;
    const std::string key = base64(nonce);
    line_->write(bytesOf(webSocketRequest(host, key)));

    std::string             text;
    std::optional<HttpHead> head;
    for (const double until = line_->now() + timeout; !(head = readHttpHead(text));)
        if (!readMore(*line_, text, until)) throw WebSocketError("no answer to a request for a WebSocket");
    if (head->first.find(" 101") == std::string::npos)
        throw WebSocketError("a WebSocket was refused: \"" + head->first.substr(0, 60) + "\"");
    if (head->field("Sec-WebSocket-Accept") != webSocketAccept(key))
        throw WebSocketError("a WebSocket was accepted with a wrong key");
    reader_.feed(bytesOf(std::string_view(text).substr(head->size)));
}

/// A generator after Marsaglia (2003), "Xorshift RNGs": masks keep proxies from mistaking a payload, no more.
std::array<std::uint8_t, 4> WebSocketClient::mask() noexcept
{
    random_ ^= random_ << 13U;
    random_ ^= random_ >> 7U;
    random_ ^= random_ << 17U;
    return {std::uint8_t(random_), std::uint8_t(random_ >> 8U), std::uint8_t(random_ >> 16U),
            std::uint8_t(random_ >> 24U)};
}

void WebSocketClient::send(std::string_view text)
{
    line_->write(bytesOf(webSocketFrame(WebSocketKind::text, text, mask())));
}

void WebSocketClient::sendForce(std::string_view text)
{
    line_->writeForce(bytesOf(webSocketFrame(WebSocketKind::text, text, mask())));
}

std::optional<std::string> WebSocketClient::receive(double timeout)
{
    const double until = line_->now() + timeout;
    for (bool isLast = false;;) { // a flood of what is no text must not hold the caller
        while (std::optional<WebSocketMessage> message = reader_.next()) {
            if (message->kind == WebSocketKind::close) throw LineEnded("the service has said goodbye");
            if (message->kind == WebSocketKind::ping)
                line_->write(bytesOf(webSocketFrame(WebSocketKind::pong, message->payload, mask())));
            if (message->kind == WebSocketKind::text) return std::move(message->payload);
        }
        std::array<std::uint8_t, 4096> bytes{};
        if (isLast) return {};
        const double      left = std::max(0.0, until - line_->now());
        const std::size_t got  = line_->read(bytes, left);
        isLast                 = !(until - line_->now() > 0);
        if (got == 0 && isLast) return {};
        reader_.feed(std::span(bytes).first(got));
    }
}

void WebSocketClient::sayGoodbye() noexcept
{
    try {
        line_->write(bytesOf(webSocketFrame(WebSocketKind::close, "\x03\xE8", mask())));
    } catch (const std::exception&) { // it is gone already
    }
}

// --- HTTP

std::string askHaply(const HaplyOpener& open, std::string_view path, double timeout)
{
    const std::unique_ptr<ByteLine> line = open(HaplyPort::service);
    line->write(bytesOf("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"));
    std::string text;
    for (const double until = line->now() + timeout; readMore(*line, text, until);) {
        const std::optional<HttpHead> head = readHttpHead(text);
        if (!head) continue;
        const std::size_t length = std::strtoul(head->field("Content-Length").c_str(), nullptr, 10);
        if (length > 0 && text.size() - head->size >= length) break;
    }
    const std::optional<HttpHead> head = readHttpHead(text);
    return head && head->first.find(" 200") != std::string::npos ? text.substr(head->size) : std::string();
}

HaplyService inspectHaply(const HaplyOpener& open, double timeout)
{
    HaplyService service;
    service.version    = versionIn(askHaply(open, "/version", timeout));
    service.forceScale = forceScaleIn(askHaply(open, "/settings/devices/force_scale", timeout));
    WebSocketClient client(open(HaplyPort::service), "localhost", timeout);
    if (const auto picture = client.receive(timeout)) service.devices = haplyDevices(*picture, &service.hasGrips);
    client.sayGoodbye();
    return service;
}

std::string describeFilters(const HaplyDescription& device, std::optional<double> forceScale)
{
    std::string said;
    const auto  add = [&](const std::string& what) { said += (said.empty() ? "" : ", ") + what; };
    if (!device.forceGate && !device.damping && !forceScale)
        return "the Inverse Service does not say whether it filters forces";
    if (device.damping.value_or(0) != 0) add("damping of " + decimal(*device.damping));
    if (forceScale.value_or(1) != 1) add("a force scale of " + decimal(*forceScale));
    return said.empty() ? said
                        : "the Inverse Service changes forces by " + said + ": what is felt is not what is asked";
}

std::string describeGate(const HaplyDescription& device)
{
    if (device.forceGate.value_or(0) == 0) return "";
    return "the Inverse Service's force gate is " + decimal(*device.forceGate) +
           ": it lessens a force while the service finds that the arm oscillates, and no other";
}

HapticDeviceInfo haplyInfo(const std::string& type)
{
    HapticDeviceInfo info;
    const bool       isSmall = type == "minverse";
    info.model               = isSmall ? "Haply Minverse" : "Haply Inverse3";
    info.workspaceRadius     = isSmall ? 0.04 : 0.10; // as in Haply's tutorials, as is the next but one
    info.maximumForce        = 5;                     // SOFA's client clamps to 5 N, ROS's to 10 N
    info.maximumStiffness    = 800;
    info.maximumDamping      = 3;
    info.buttons             = 4;
    info.rotates             = true; // with a grip
    return info;
}

// --- the conversation

HaplyLine::HaplyLine(HaplyOpener open, const HaplyLineSettings& settings) : open_(std::move(open)), settings_(settings)
{
    if (!settings.id.empty() && !isHaplyId(settings.id))
        throw Error("Haply: expected a device's number such as 049D, found \"" + settings.id +
                    "\"; palpate devices lists them");
}

void HaplyLine::open(HapticDeviceInfo& info)
{
    state_ = {};
    moved_.restart();
    inFlight_ = pushes_ = confirmed_ = swapped_ = isGone_ = isBraked_ = takesNone_ = false;
    unheard_ = absent_ = unasked_ = 0;
    stoppedUntil_                 = 0;
    stopWords_                    = "";
    silenced_                     = 0;
    try {
        HaplyService           service;
        const HaplyDescription device = greet(findDevice(settings_.openWait, service));
        const bool             isSim  = info.isSimulation;
        info                          = haplyInfo(device.type);
        info.isSimulation             = isSim;
        if (isSim) info.model = "emulated " + info.model;
        info.path    = settings_.host + "/" + device.id;
        info.serial  = device.serial.empty() ? device.id : device.serial;
        info.rotates = service.hasGrips;
        info.note    = describeFilters(device, service.forceScale);
        if (device.preset != "arm_front_centered")
            info.note += std::string(info.note.empty() ? "" : "; ") +
                         "the Inverse Service does not say that its origin is the middle of the workspace";
        dialect_ = dialectOf(service.version).value_or(HaplyDialect::vector);
        client_->line().guard(kHaplyZero);
    } catch (const LineEnded& ended) {
        close();
        throw Error("Haply's Inverse Service does not answer at " + settings_.host + " (" + ended.what() +
                    "): is haply-inverse-service running? systemctl status haply-inverse-service");
    } catch (const WebSocketError& error) {
        close();
        throw Error(settings_.host + " is no Inverse Service: " + error.what() +
                    "; see the port in its settings, 10001 as it is shipped");
    } catch (...) {
        close();
        throw;
    }
    try {
        events_ = std::make_unique<WebSocketClient>(open_(HaplyPort::events), "localhost", 0.2);
    } catch (const std::exception&) {
        info.note +=
            std::string(info.note.empty() ? "" : "; ") +
            "the Inverse Service tells no events: an emergency brake is noticed by its force alone, 0.2 s later";
    }
}

void HaplyLine::refuse(const HaplyService& service) const
{
    std::string found;
    for (const HaplyDescription& device : service.devices) found += (found.empty() ? "" : ", ") + device.id;
    if (service.devices.empty()) found = service.hasGrips ? "a grip alone" : "no device";
    throw Error("Haply's Inverse Service at " + settings_.host + " knows " + found + ", and no Inverse3 or Minverse" +
                (settings_.id.empty() ? "" : " with the number " + settings_.id) +
                "; plug it in and switch it on, palpate devices lists what there is");
}

/// Connects until the service lists the device. A session is configured by its first message, so each try is a new one.
HaplyDescription HaplyLine::findDevice(double until, HaplyService& service)
{
    service.version    = versionIn(askHaply(open_, "/version", 1));
    service.forceScale = forceScaleIn(askHaply(open_, "/settings/devices/force_scale", 1));
    for (double waited = 0;;) {
        client_              = std::make_unique<WebSocketClient>(open_(HaplyPort::service), "localhost", 1);
        const double tried   = client_->line().now(); // a line's clock may begin with the line
        const auto   picture = client_->receive(std::max(kTry, until - waited));
        const auto&  devices = service.devices = haplyDevices(picture.value_or(""), &service.hasGrips);
        const auto   found                     = std::ranges::find_if(devices, [&](const HaplyDescription& device) {
            return settings_.id.empty() || isSameId(device.id, settings_.id);
        });
        if (found != devices.end()) return *found;
        while (client_->line().now() - tried < kTry) static_cast<void>(client_->receive(kTry));
        waited += client_->line().now() - tried;
        if (waited >= until) refuse(service);
    }
}

/// Sends the first message, and reads what the device then says of itself.
HaplyDescription HaplyLine::greet(HaplyDescription device)
{
    id_ = device.id;
    client_->send(haplyGreeting(id_));
    for (int n = 0; n < 3; ++n) { // a service may send an ordinary answer before the whole picture
        const auto answer = client_->receive(0.3);
        if (!answer) break;
        for (const HaplyDescription& found : haplyDevices(*answer))
            if (found.id == id_ && !found.type.empty()) device = found;
        if (!device.preset.empty() && device.preset != "defaults") break;
    }
    state_.calibrated = device.calibrated;
    state_.ready      = device.ready;
    return device;
}

void HaplyLine::close() noexcept
{
    if (client_) {
        letGo();
        client_->sayGoodbye();
    }
    client_.reset();
    events_.reset();
}

void HaplyLine::letGo() noexcept
{
    for (int n = 0; n < 2; ++n) {
        try {
            if (pushes_) client_->sendForce(haplyCommand(id_, dialect_, glm::dvec3(0)));
            pushes_ = false;
            if (!id_.empty()) client_->sendForce(haplyCommand(id_, dialect_, {}));
            return;
        } catch (const GuardianEnded&) {  // told once, and stops one packet
        } catch (const std::exception&) { // the line takes nothing any more: silence is zero for the service
            return;
        }
    }
}

void HaplyLine::lose(LineSample& sample, DeviceFault fault, const char* words) noexcept
{
    sample.fault = fault;
    sample.words = words;
    if (client_) letGo();
    client_.reset();
    events_.reset();
}

void HaplyLine::exchange(const LineOrder& order, LineSample& sample) noexcept
{
    if (!client_) return;
    try {
        clock_ = client_->line().now();
        hearEvents(clock_);
        int heard = 0;
        while (heard < kAtOnce && hear(0, sample)) ++heard;
        unasked_ = heard > 1 ? unasked_ + 1 : 0;
        if (unasked_ > kPatience) // one request has one answer: these may be old
            stop(clock_ + kStopped, "the Inverse Service sends answers that nobody asked for");
        const bool mustLetGo = pushes_ && !order.enable;
        if (!inFlight_ || mustLetGo || clock_ - asked_ > kGiveUp) say(order, clock_);
        static_cast<void>(hear(settings_.answerWait, sample));
    } catch (const GuardianEnded&) {
        return lose(sample, DeviceFault::linkLost, "the guardian process has ended, without which no force goes out");
    } catch (const LineEnded&) {
        return lose(sample, DeviceFault::linkLost,
                    "the Inverse Service ended the connection; is haply-inverse-service still running?");
    } catch (const WebSocketError&) {
        return lose(sample, DeviceFault::linkLost, "the Inverse Service sent bytes that are no WebSocket");
    } catch (const std::exception&) {
        return lose(sample, DeviceFault::linkLost, "no memory for the Inverse Service's answers");
    }
    if (absent_ > kAbsent)
        return lose(sample, DeviceFault::unplugged, "the Inverse Service no longer lists the device");
    if (isGone_) return lose(sample, DeviceFault::unplugged, stopWords_);
    const char* const why = whyStopped();
    sample.fault          = why ? DeviceFault::ownWatchdog : DeviceFault::none;
    sample.words          = why ? why : "";
    sample.silenced       = silenced_;
}

/// Stops forces for a while; a stop that lasts longer stays.
void HaplyLine::stop(double until, const char* words) noexcept
{
    if (until < stoppedUntil_) return;
    stoppedUntil_ = until;
    stopWords_    = words;
}

/// Returns why no force may be asked for; null: it may.
const char* HaplyLine::whyStopped() const noexcept
{
    if (isBraked_) return brakeWords_;
    if (takesNone_)
        return "the Inverse Service does not take forces; update it, or see whether another program drives the device";
    return clock_ < stoppedUntil_ ? stopWords_ : nullptr;
}

void HaplyLine::hearEvents(double now)
{
    if (!events_) return;
    try {
        for (int n = 0; n < kAtOnce; ++n) {
            const auto text = events_->receive(0);
            if (!text) return;
            const HaplyEvent event = haplyEvent(*text, id_);
            if (event.kind == HaplyEvent::Kind::nothing) continue;
            if (event.kind == HaplyEvent::Kind::gone) {
                isGone_ = true;
                stop(kForever, event.words);
            } else if (event.kind == HaplyEvent::Kind::braked) {
                isBraked_   = true;
                brakeWords_ = event.words;
            } else {
                const bool isRelease = event.kind == HaplyEvent::Kind::released;
                isBraked_            = isBraked_ && !isRelease;
                stop(now + (isRelease ? kPause : kStopped), event.words);
            }
        }
    } catch (const std::exception&) {
        events_.reset();
        stop(kForever,
             "the Inverse Service tells no events any more, such as an emergency brake; start the session again");
    }
}

/// Reads one message.
/// \return whether there was one
bool HaplyLine::hear(double timeout, LineSample& sample)
{
    const std::optional<std::string> answer = client_->receive(timeout);
    if (!answer) return false;
    inFlight_ = false;
    take(*answer, sample);
    return true;
}

void HaplyLine::take(const std::string& answer, LineSample& sample)
{
    const HaplyVerdict verdict = takeHaplyState(answer, id_, state_);
    absent_                    = verdict == HaplyVerdict::noDevice ? absent_ + 1 : 0;
    if (verdict == HaplyVerdict::noDevice) return;
    if (verdict == HaplyVerdict::garbled) {
        if (sample.news == LineNews::none) sample.news = LineNews::garbled;
        return;
    }
    checkEcho();
    sample.news     = LineNews::sample;
    sample.position = state_.position;
    moved_.add(clock_, state_.position);
    sample.velocity    = state_.velocity.value_or(moved_.velocity());
    sample.orientation = state_.orientation;
    sample.buttons     = state_.buttons;
    sample.homed       = state_.calibrated && state_.ready;
    sample.age         = std::clamp(client_->line().now() - asked_, 0.0, kGiveUp);
}

/// Compares what the service says it renders with what it was sent.
void HaplyLine::checkEcho()
{
    const bool isAsked = pushes_ && sent_ >= kLeastEcho && state_.rendered; // what it does not say proves nothing
    const bool isShown = isAsked && glm::length(*state_.rendered) >= kEchoShare * sent_;
    confirmed_         = confirmed_ || isShown;
    unheard_           = isAsked && !isShown ? unheard_ + 1 : 0;
    if (unheard_ < (confirmed_ ? kLater : kPatience)) return;
    unheard_ = 0;
    if (confirmed_)
        return stop(clock_ + kStopped,
                    "the Inverse Service no longer renders the force; does another program drive the device?");
    takesNone_ = swapped_;
    if (takesNone_) return;
    swapped_ = true;
    dialect_ = dialect_ == HaplyDialect::vector ? HaplyDialect::values : HaplyDialect::vector;
    stop(clock_ + kPause, "the Inverse Service ignored a force; the other word for it is tried");
}

void HaplyLine::say(const LineOrder& order, double now)
{
    pushes_ = pushes_ || order.enable; // until what says otherwise has gone out
    client_->sendForce(haplyCommand(id_, dialect_, order.enable ? std::optional(order.force) : std::nullopt));
    pushes_   = order.enable;
    sent_     = order.enable ? glm::length(order.force) : 0;
    inFlight_ = true;
    asked_    = now;
    if (client_->line().wasSilenced()) ++silenced_;
}

} // namespace palp
