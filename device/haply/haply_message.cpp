#include "device/haply/haply_message.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <span>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/json_limits.h"

namespace palp {
namespace {

using Json = nlohmann::json;

constexpr double kMostForce =
    9.9999; ///< [N] beyond any Haply. With one digit before the point its zero is a number too
constexpr double           kMostNumber = 1e6; ///< a place, a speed or a force beyond it is none
constexpr std::string_view kForceWord  = "\"set_cursor_force\"";

/// Parses without exceptions; a discarded value is not understood.
Json parsed(std::string_view text)
{
    return excessOf(text) ? Json(Json::value_t::discarded) : Json::parse(text, nullptr, false);
}

/// Returns what lies at a path of keys; null if nothing does.
const Json* at(const Json& json, std::initializer_list<const char*> keys)
{
    const Json* here = &json;
    for (const char* key : keys) {
        if (!here->is_object()) return nullptr;
        const auto found = here->find(key);
        if (found == here->end()) return nullptr;
        here = &*found;
    }
    return here;
}

std::optional<double> numberAt(const Json& json, std::initializer_list<const char*> keys)
{
    const Json* value = at(json, keys);
    if (!value || !value->is_number()) return {};
    const double number = value->get<double>();
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::optional<bool> truthAt(const Json& json, std::initializer_list<const char*> keys)
{
    const Json* value = at(json, keys);
    return value && value->is_boolean() ? std::optional(value->get<bool>()) : std::nullopt;
}

std::string textAt(const Json& json, std::initializer_list<const char*> keys)
{
    const Json* value = at(json, keys);
    return value && value->is_string() ? value->get<std::string>() : std::string();
}

/// Reads {"x": , "y": , "z": } in our frame; empty if a number is missing or is none.
std::optional<glm::dvec3> vectorAt(const Json& json, std::initializer_list<const char*> keys)
{
    const Json* value = at(json, keys);
    if (!value) return {};
    glm::dvec3            read{};
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
        const auto number = numberAt(*value, {kAxes[axis]});
        if (!number || !(std::abs(*number) < kMostNumber)) return {};
        read[axis] = *number;
    }
    return fromHaply(read);
}

/// Reads a turn in our frame; empty if it is no unit quaternion.
std::optional<glm::dquat> turnAt(const Json& json, std::initializer_list<const char*> keys)
{
    const Json* value = at(json, keys);
    const auto  axis  = vectorAt(json, keys);
    const auto  w     = value ? numberAt(*value, {"w"}) : std::nullopt;
    if (!axis || !w || !(std::abs(*w) < 2)) return {};
    const glm::dquat turn(*w, axis->x, axis->y, axis->z);
    const double     size = glm::length(turn);
    return size > 0.9 && size < 1.1 ? std::optional(turn / size) : std::nullopt;
}

/// Returns the element of a list that has an id; with an empty id the first.
const Json* elementOf(const Json& json, const char* list, std::string_view id)
{
    const Json* all = at(json, {list});
    if (!all || !all->is_array()) return nullptr;
    for (const Json& one : *all)
        if (one.is_object() && (id.empty() || textAt(one, {"device_id"}) == id)) return &one;
    return nullptr;
}

constexpr std::array kGrips{"verse_grip", "wireless_verse_grip", "custom_verse_grip"};

/// Takes the first grip that there is.
void takeGrip(const Json& json, HaplyState& state)
{
    state.buttons = 0; // of a grip that says nothing none is held: it may have gone to sleep
    for (const char* list : kGrips) {
        const Json* grip = elementOf(json, list, {});
        if (!grip || !at(*grip, {"state"})) continue;
        if (const auto turn = turnAt(*grip, {"state", "orientation"})) {
            state.orientation = *turn;
            state.hasGrip     = true;
        }
        state.buttons                    = truthAt(*grip, {"state", "button"}).value_or(false) ? 1 : 0;
        constexpr const char* kLetters[] = {"a", "b", "c", "home"};
        constexpr const char* kNumbers[] = {"button_0", "button_1", "button_2", "button_3"};
        for (unsigned n = 0; n < 4; ++n)
            if (truthAt(*grip, {"state", "buttons", kLetters[n]}).value_or(false) ||
                truthAt(*grip, {"state", "buttons", kNumbers[n]}).value_or(false))
                state.buttons |= 1U << n;
        return;
    }
}

HaplyDescription describe(const Json& device)
{
    HaplyDescription out;
    out.id         = textAt(device, {"device_id"});
    out.type       = textAt(device, {"config", "type"});
    out.serial     = textAt(device, {"config", "device_info", "uuid"});
    out.preset     = textAt(device, {"config", "preset"});
    out.calibrated = truthAt(device, {"status", "calibrated"}).value_or(false);
    out.ready      = truthAt(device, {"status", "ready"}).value_or(false);
    out.forceGate  = numberAt(device, {"config", "filters", "force_gate", "gain"});
    out.damping    = numberAt(device, {"config", "filters", "damping", "scalar"});
    if (out.preset.empty()) out.preset = textAt(device, {"config", "preset", "preset"});
    return out;
}

// --- frames, for the guardian; they allocate nothing

struct FramePayload {
    std::size_t start = 0, size = 0; ///< [byte]
};

/// Finds the payload of a masked text frame that is whole; empty if it is none.
FramePayload payloadOf(std::span<const std::uint8_t> frame) noexcept
{
    if (frame.size() < 6 || frame[0] != 0x81 || (frame[1] & 0x80U) == 0) return {};
    const std::size_t length = frame[1] & 0x7FU, field = length == 126 ? 2 : 0, start = 2 + field + 4;
    if (length == 127 || frame.size() < start) return {};
    const std::size_t size = field > 0 ? std::size_t(frame[2]) << 8U | frame[3] : length;
    return frame.size() == start + size ? FramePayload{start, size} : FramePayload{};
}

char maskOf(std::span<const std::uint8_t> frame, const FramePayload& payload, std::size_t n) noexcept
{
    return char(frame[payload.start - 4 + n % 4]);
}

char plain(std::span<const std::uint8_t> frame, const FramePayload& payload, std::size_t n) noexcept
{
    return char(frame[payload.start + n] ^ std::uint8_t(maskOf(frame, payload, n)));
}

/// Returns where the coordinates of a force begin in a payload; its size if there are none.
std::size_t forceIn(std::span<const std::uint8_t> frame, const FramePayload& payload) noexcept
{
    for (std::size_t n = 0; n + kForceWord.size() <= payload.size; ++n) {
        std::size_t same = 0;
        while (same < kForceWord.size() && plain(frame, payload, n + same) == kForceWord[same]) ++same;
        if (same == kForceWord.size()) return n + same;
    }
    return payload.size;
}

bool pushes(std::span<const std::uint8_t> frame) noexcept
{
    const FramePayload payload = payloadOf(frame);
    for (std::size_t n = forceIn(frame, payload); n < payload.size; ++n)
        if (const char c = plain(frame, payload, n); c >= '1' && c <= '9') return true;
    return false;
}

void silence(std::span<std::uint8_t> frame) noexcept
{
    const FramePayload payload = payloadOf(frame);
    for (std::size_t n = forceIn(frame, payload); n < payload.size; ++n) {
        const char c             = plain(frame, payload, n);
        const char z             = c >= '1' && c <= '9' ? '0' : c == '-' ? ' ' : c;
        frame[payload.start + n] = std::uint8_t(z ^ maskOf(frame, payload, n));
    }
}

} // namespace

const ZeroRule kHaplyZero{.pushes = pushes, .silence = silence};

std::optional<HaplyDialect> dialectOf(std::string_view version)
{
    if (version.starts_with('v')) version.remove_prefix(1);
    int         major = 0, minor = 0;
    const char* end   = version.data() + version.size();
    const auto  first = std::from_chars(version.data(), end, major);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return {};
    const auto second = std::from_chars(first.ptr + 1, end, minor);
    if (second.ec != std::errc()) return {};
    return major > 3 || (major == 3 && minor >= 5) ? HaplyDialect::vector : HaplyDialect::values;
}

std::string versionIn(std::string_view json)
{
    const Json answer = parsed(json);
    for (const char* key : {"git_tag", "version"}) {
        if (std::string text = textAt(answer, {"data", key}); !text.empty()) return text;
        if (std::string text = textAt(answer, {key}); !text.empty()) return text;
    }
    return {};
}

std::optional<double> forceScaleIn(std::string_view json)
{
    const Json answer = parsed(json);
    for (const auto& keys : {std::initializer_list<const char*>{"data"}, {"data", "force_scale"}, {"force_scale"}})
        if (const auto scale = numberAt(answer, keys)) return scale;
    return {};
}

bool isHaplyId(std::string_view id) noexcept
{
    constexpr std::size_t kMost = 32;
    return !id.empty() && id.size() <= kMost &&
           std::ranges::all_of(id, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

namespace {

/// Returns a force of less than 10 N with four decimal places, always of seven characters, whatever the locale of a
/// host.
std::string inNewtons(double force)
{
    std::array<char, 32> digits{};
    const auto           end =
        std::to_chars(digits.data(), digits.data() + digits.size(), force, std::chars_format::fixed, 4).ptr;
    const std::string     text(digits.data(), end);
    constexpr std::size_t kWidth = 7;
    return std::string(kWidth - std::min(kWidth, text.size()), ' ') + text;
}

} // namespace

std::string haplyCommand(std::string_view id, HaplyDialect dialect, const std::optional<glm::dvec3>& force)
{
    PALP_EXPECT(isHaplyId(id), "a device's id, found \"" + std::string(id) + "\"");
    // Adding 0 turns -0 into 0.
    const glm::dvec3  there   = force ? glm::clamp(toHaply(*force), -kMostForce, kMostForce) + 0.0 : glm::dvec3(0);
    const std::string message = "{\"inverse3\":[{\"device_id\":\"" + std::string(id) +
                                "\",\"commands\":{\"set_cursor_force\":{\"" + name(dialect) +
                                "\":{\"x\":" + inNewtons(there.x) + ",\"y\":" + inNewtons(there.y) +
                                ",\"z\":" + inNewtons(there.z) + "}}}}]}";
    if (force) return message;
    std::string probe =
        "{\"inverse3\":[{\"device_id\":\"" + std::string(id) + "\",\"commands\":{\"probe_position\":{}}}]}";
    probe.resize(message.size(), ' ');
    return probe;
}

std::string haplyGreeting(std::string_view id)
{
    return Json{{"session",
                 {{"configure", {{"profile", {{"name", "org.palpate:session"}}}}},
                  {"force_render_full_state", Json::object()}}},
                {"inverse3",
                 {{{"device_id", std::string(id)},
                   {"configure", {{"preset", {{"preset", "arm_front_centered"}}}}},
                   {"commands", {{"probe_position", Json::object()}}}}}}}
        .dump();
}

std::vector<HaplyDescription> haplyDevices(std::string_view json, bool* hasGrips)
{
    const Json                    message = parsed(json);
    std::vector<HaplyDescription> devices;
    if (const Json* all = at(message, {"inverse3"}); all && all->is_array())
        for (const Json& one : *all)
            if (HaplyDescription device = describe(one); isHaplyId(device.id)) devices.push_back(std::move(device));
    if (hasGrips)
        *hasGrips =
            std::ranges::any_of(kGrips, [&](const char* list) { return elementOf(message, list, {}) != nullptr; });
    return devices;
}

HaplyVerdict takeHaplyState(std::string_view json, std::string_view id, HaplyState& state)
{
    const Json message = parsed(json);
    if (!message.is_object()) return HaplyVerdict::garbled;
    const Json* device = elementOf(message, "inverse3", id);
    if (!device) return HaplyVerdict::noDevice;
    const auto position = vectorAt(*device, {"state", "cursor_position"});
    if (!position) return HaplyVerdict::garbled;
    const Json* speed    = at(*device, {"state", "cursor_velocity"});
    const auto  velocity = vectorAt(*device, {"state", "cursor_velocity"});
    if (speed && !velocity) return HaplyVerdict::garbled;

    state.position   = *position;
    state.velocity   = velocity;
    state.rendered   = vectorAt(*device, {"state", "current_cursor_force"});
    state.calibrated = truthAt(*device, {"status", "calibrated"}).value_or(state.calibrated);
    state.ready      = truthAt(*device, {"status", "ready"}).value_or(state.ready);
    takeGrip(message, state);
    return HaplyVerdict::good;
}

HaplyEvent haplyEvent(std::string_view json, std::string_view id)
{
    using Kind = HaplyEvent::Kind;
    struct Row {
        const char* word;
        HaplyEvent  event;
    };
    static constexpr Row kNames[] = {
        {"device-disconnected", {Kind::gone, "the Haply was unplugged"}},
        {"device-sleep", {Kind::stopped, "the Haply fell asleep; move it"}},
        {"device-busy", {Kind::stopped, "another program uses the Haply"}},
        {"device-battery-critical", {Kind::stopped, "the battery is empty"}},
        {"device-connection-loop", {Kind::stopped, "the Haply loses its connection again and again; check its cable"}},
        {"device-calibration-failed", {Kind::stopped, "the Haply's calibration failed; follow the service's guide"}}};
    static constexpr Row kSafety[] = {
        {"ebrake_triggered", {Kind::braked, "the Haply's emergency brake acts"}},
        {"ebrake_released", {Kind::released, "the Haply's emergency brake was released"}},
        {"fod_stage_changed", {Kind::stopped, "the Haply changed its own limit of the force (fod_stage_changed)"}},
        {"stall_detected", {Kind::stopped, "a motor of the Haply stalls"}},
        {"stability_ceiling", {Kind::stopped, "the Haply found its loop unstable"}}};

    const Json  event = parsed(json);
    std::string whose = textAt(event, {"data", "device_id"});
    if (!whose.empty() && whose != id) return {};
    const std::string name = textAt(event, {"name"}), safety = textAt(event, {"data", "safety_type"});
    for (const Row& row : kNames)
        if (name == row.word) return row.event;
    if (name != "device-safety-triggered") return {};
    for (const Row& row : kSafety)
        if (safety == row.word) return row.event;
    return {Kind::stopped, "the Haply stopped for its own safety"};
}

} // namespace palp
