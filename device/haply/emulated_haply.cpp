#include "device/haply/emulated_haply.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/core/json_limits.h"

namespace palp {
namespace {

using Json = nlohmann::json;

constexpr double kPiece = 1e-3; ///< [s] the service's own tick, assumed

Json vectorOf(const glm::dvec3& ours)
{
    const glm::dvec3 v = toHaply(ours);
    return {{"x", v.x}, {"y", v.y}, {"z", v.z}};
}

Json turnOf(const glm::dquat& ours)
{
    const glm::dvec3 axis = toHaply({ours.x, ours.y, ours.z});
    return {{"w", ours.w}, {"x", axis.x}, {"y", axis.y}, {"z", axis.z}};
}

std::string httpAnswer(const Json& data)
{
    const std::string body = Json{{"ok", true}, {"data", data}}.dump();
    return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
           "\r\n\r\n" + body;
}

/// A line in this process. A wait for bytes passes on the line's own clock alone.
class EmulatedLine : public ByteLine {
public:
    EmulatedLine(EmulatedHaply& service, std::shared_ptr<EmulatedHaply::Peer> peer)
        : service_(service), peer_(std::move(peer))
    {
    }
    ~EmulatedLine() override { peer_->isClosed = true; }

    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        const std::size_t most = peer_->isSlow() ? 1 : bytes.size();
        const std::size_t size = std::min(most, peer_->out.size());
        if (size == 0 && peer_->isClosed) throw LineEnded("the emulated service has closed the connection");
        if (size == 0) waited_ += std::max(0.0, timeout);
        std::copy_n(peer_->out.begin(), size, bytes.begin());
        peer_->out.erase(0, size);
        return size;
    }
    void write(std::span<const std::uint8_t> bytes) override
    {
        if (peer_->isClosed) throw LineEnded("the emulated service has closed the connection");
        peer_->receive(bytes);
    }
    [[nodiscard]] double now() const noexcept override { return service_.now() + waited_; }

private:
    EmulatedHaply&                       service_;
    std::shared_ptr<EmulatedHaply::Peer> peer_;
    double                               waited_ = 0; ///< [s]
};

} // namespace

EmulatedHaply::EmulatedHaply(EmulatedHaplySettings settings, Arm arm)
    : settings_(std::move(settings)), arm_(std::move(arm)), time_(settings_.start)
{
    if (arm_) position_ = arm_(glm::dvec3(0), 0);
}

std::shared_ptr<EmulatedHaply::Peer> EmulatedHaply::accept(HaplyPort port)
{
    if (isStopped_) throw LineEnded("the emulated service is stopped");
    std::erase_if(peers_, [](const auto& peer) { return peer->isClosed; });
    peers_.push_back(std::make_shared<Peer>(*this, port));
    return peers_.back();
}

std::unique_ptr<ByteLine> EmulatedHaply::connect(HaplyPort port)
{
    return std::make_unique<EmulatedLine>(*this, accept(port));
}

HaplyOpener EmulatedHaply::opener()
{
    return [this](HaplyPort port) { return connect(port); };
}

void EmulatedHaply::stop()
{
    isStopped_ = true;
    for (const auto& peer : peers_) peer->isClosed = true;
}

void EmulatedHaply::raise(const std::string& event)
{
    for (const auto& peer : peers_)
        if (peer->port_ == HaplyPort::events && peer->isSocket) peer->out += webSocketFrame(WebSocketKind::text, event);
}

void EmulatedHaply::endEvents()
{
    for (const auto& peer : peers_)
        if (peer->port_ == HaplyPort::events) peer->isClosed = true;
}

void EmulatedHaply::repeat()
{
    for (const auto& peer : peers_)
        if (peer->port_ == HaplyPort::service && peer->isSocket)
            peer->out += webSocketFrame(WebSocketKind::text, picture(false, true));
}

glm::dvec3 EmulatedHaply::force() const noexcept
{
    return commanded_ >= 0 && time_ < commanded_ + settings_.hold ? force_ : glm::dvec3(0);
}

void EmulatedHaply::moveTo(double time)
{
    while (time_ < time) {
        double       until = std::min(time, time_ + kPiece);
        const double limp  = commanded_ + settings_.hold;
        if (commanded_ >= 0 && limp > time_) until = std::min(until, limp);
        const glm::dvec3 push = force(), before = position_;
        if (arm_) position_ = arm_(push, until - time_);
        if (until > time_) velocity_ = (position_ - before) / (until - time_);
        time_ = until;
        if (push != glm::dvec3(0)) lastForce_ = time_;
    }
}

std::string EmulatedHaply::picture(bool isFull, bool hasPreset) const
{
    Json message{{"inverse3", Json::array()}, {"verse_grip", Json::array()}};
    if (isFull) message["session_id"] = 0;
    const bool isListed = isFull || trouble_ != HaplyTrouble::unlisted;
    for (std::size_t n = 0; isListed && n < settings_.ids.size(); ++n) {
        const bool isMoved = n == 0;
        Json       device{
            {"device_id", settings_.ids[n]},
            {"state",
                   {{"cursor_position", vectorOf(isMoved ? position_ : glm::dvec3(0))},
                    {"cursor_velocity", vectorOf(isMoved ? velocity_ : glm::dvec3(0))},
                    {"current_cursor_force", vectorOf(isMoved ? force() : glm::dvec3(0))},
                    {"control_mode", force() == glm::dvec3(0) ? "idle" : "force"}}},
            {"status", {{"calibrated", trouble_ != HaplyTrouble::uncalibrated}, {"in_use", true}, {"ready", true}}}};
        if (!settings_.echoes) device["state"].erase("current_cursor_force");
        if (!settings_.hasSpeed) device["state"].erase("cursor_velocity");
        if (trouble_ == HaplyTrouble::huge) device["state"]["cursor_position"]["x"] = 1e308;
        if (trouble_ == HaplyTrouble::keyless) device["state"].erase("cursor_position");
        if (isFull)
            device["config"] = {
                {"type", "inverse3"},
                {"device_info", {{"id", settings_.ids[n]}, {"uuid", "emulated-" + settings_.ids[n]}}},
                {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1}}},
                {"filters", {{"force_gate", {{"gain", settings_.forceGate}}}, {"damping", {{"scalar", 0}}}}},
                {"preset", hasPreset ? "arm_front_centered" : "defaults"}};
        message["inverse3"].push_back(std::move(device));
    }
    if (settings_.hasGrip)
        message["wireless_verse_grip"] = {{{"device_id", "61576"},
                                           {"state",
                                            {{"orientation", turnOf(orientation_)},
                                             {"buttons",
                                              {{"a", (buttons_ & 1U) != 0},
                                               {"b", (buttons_ & 2U) != 0},
                                               {"c", (buttons_ & 4U) != 0},
                                               {"home", (buttons_ & 8U) != 0}}}}},
                                           {"status", {{"connected", true}, {"ready", true}}}}};
    std::string text = message.dump();
    if (trouble_ == HaplyTrouble::notANumber)
        if (const std::size_t at = text.find("\"cursor_position\":{\"x\":"); at != std::string::npos)
            text.insert(at + 23, "NaN,\"unread\":");
    return text;
}

// --- one connection

void EmulatedHaply::Peer::receive(std::span<const std::uint8_t> bytes)
{
    if (isSocket) {
        reader_.feed(bytes);
    } else {
        head_.append(bytes.begin(), bytes.end());
        const std::optional<HttpHead> head = readHttpHead(head_);
        if (!head) return;
        answerHttp(*head);
        const std::string rest = head_.substr(head->size);
        reader_.feed(std::span(reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()));
    }
    while (const std::optional<WebSocketMessage> message = reader_.next()) {
        if (message->kind == WebSocketKind::close) isClosed = true;
        if (message->kind != WebSocketKind::text || port_ != HaplyPort::service) continue;
        try {
            obey(message->payload);
        } catch (const Json::exception&) { // no request of a client
            isClosed = true;
        }
    }
}

void EmulatedHaply::Peer::answerHttp(const HttpHead& head)
{
    const std::string key = head.field("Sec-WebSocket-Key");
    if (!key.empty()) {
        isSocket = true;
        out +=
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nsec-websocket-accept: " +
            webSocketAccept(key) + "\r\n\r\n";
        if (port_ == HaplyPort::service) out += webSocketFrame(WebSocketKind::text, service_.picture(true, hasPreset_));
        return;
    }
    if (head.first.starts_with("GET /version"))
        out += httpAnswer({{"git_tag", service_.settings_.version}});
    else if (head.first.starts_with("GET /settings/devices/force_scale"))
        out += httpAnswer(service_.settings_.forceScale);
    else
        out += "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n";
    isClosed = true;
}

void EmulatedHaply::Peer::obey(const std::string& message)
{
    ++service_.requests_;
    const Json request   = excessOf(message) ? Json() : Json::parse(message, nullptr, false);
    const bool wantsFull = request.contains("/session/force_render_full_state"_json_pointer);
    const auto profile   = "/session/configure/profile/name"_json_pointer;
    if (request.contains(profile)) service_.profile_ = request[profile].get<std::string>();
    for (const Json& device : request.value("inverse3", Json::array())) {
        if (device.contains("/configure/preset"_json_pointer)) hasPreset_ = true;
        if (service_.settings_.ids.empty() || device.value("device_id", "") != service_.settings_.ids.front()) continue;
        const Json  commands = device.value("commands", Json::object());
        const Json  push     = commands.value("set_cursor_force", Json::object());
        const Json* vector =
            push.contains(name(service_.settings_.dialect)) ? &push[name(service_.settings_.dialect)] : nullptr;
        service_.commanded_ = service_.time_;
        service_.force_     = {};
        if (vector && service_.settings_.takesForce)
            service_.force_ = service_.settings_.forceScale *
                              fromHaply({vector->value("x", 0.0), vector->value("y", 0.0), vector->value("z", 0.0)});
    }
    reply(service_.picture(wantsFull, hasPreset_));
}

void EmulatedHaply::Peer::reply(const std::string& json)
{
    const std::string whole = webSocketFrame(WebSocketKind::text, json);
    switch (service_.trouble_) {
    case HaplyTrouble::silence:
        return;
    case HaplyTrouble::garbage:
        out += webSocketFrame(WebSocketKind::text, json.substr(0, json.size() / 2) + "}#");
        return;
    case HaplyTrouble::brokenFrame:
        out += "\xFF\xFF not a frame";
        return;
    case HaplyTrouble::merged:
        out += whole + whole;
        return;
    case HaplyTrouble::fragments: {
        const std::size_t third = json.size() / 3;
        std::string       first = webSocketFrame(WebSocketKind::text, json.substr(0, third));
        std::string       next  = webSocketFrame(WebSocketKind::text, json.substr(third, third));
        std::string       last  = webSocketFrame(WebSocketKind::text, json.substr(2 * third));
        first[0]                = 0x01; // text, not final
        next[0]                 = 0x00;
        last[0]                 = char(0x80);
        out += first + webSocketFrame(WebSocketKind::ping, "still there?") + next + last;
        return;
    }
    case HaplyTrouble::cut:
        out += whole.substr(0, whole.size() / 2);
        isClosed = true;
        return;
    default:
        out += whole;
    }
}

} // namespace palp
