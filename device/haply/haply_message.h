#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "device/zero_rule.h"
#include "engine/core/enum_names.h"

// What is said to Haply's Inverse Service, and what it answers: JSON. Its frame has x right, y forward and z up; ours
// has y up and z towards the user, so (x, y, z) there is (x, z, -y) here.
namespace palp {

/// The word before the coordinates of a force. A service knows one of the two, and ignores the other without a word.
enum class HaplyDialect : std::uint8_t {
    vector, ///< from version 3.5
    values  ///< before
};
constexpr auto namesOf(HaplyDialect)
{
    using enum HaplyDialect;
    return std::to_array<NamedValue<HaplyDialect>>({{vector, "vector"}, {values, "values"}});
}

[[nodiscard]] constexpr glm::dvec3 fromHaply(const glm::dvec3& v) noexcept
{
    return {v.x, v.z, -v.y};
}
[[nodiscard]] constexpr glm::dvec3 toHaply(const glm::dvec3& v) noexcept
{
    return {v.x, -v.z, v.y};
}

/// Returns the dialect of a service of a version such as "3.5.1" or "v3.4"; empty if it is none.
[[nodiscard]] std::optional<HaplyDialect> dialectOf(std::string_view version);

/// Returns the version in an answer to GET /version; empty if there is none.
[[nodiscard]] std::string versionIn(std::string_view json);

/// Returns the factor in an answer to GET /settings/devices/force_scale [1]; empty if there is none.
[[nodiscard]] std::optional<double> forceScaleIn(std::string_view json);

/// Returns whether a name can stand in a command: letters, digits, '-' and '_', at most 32.
[[nodiscard]] bool isHaplyId(std::string_view id) noexcept;

/// Returns the message that asks for an answer. All messages to a device have one length, because its guardian replaces
/// one by the other.
/// \param force  [N] in our frame; empty: the position is asked for, and the device renders nothing
[[nodiscard]] std::string haplyCommand(std::string_view id, HaplyDialect dialect,
                                       const std::optional<glm::dvec3>& force);

/// Returns the first message of a session: its name, the origin in the middle of the workspace, and a wish for the
/// whole picture.
[[nodiscard]] std::string haplyGreeting(std::string_view id);

/// Masked frames of WebSocket that hold such a command, and their zero. For a guardian process.
extern const ZeroRule kHaplyZero;

/// What a service says of a device once, or when it is asked.
struct HaplyDescription {
    std::string           id{};
    std::string           type{}; ///< "inverse3", "minverse"
    std::string           serial{};
    std::string           preset{}; ///< where its origin is
    bool                  calibrated = false, ready = false;
    std::optional<double> forceGate{}, damping{}; ///< of the service's own filters; empty: it does not say
};

/// Reads the devices of a message.
/// \param hasGrips  whether it lists grips
/// \return empty if it lists none, or is not understood
[[nodiscard]] std::vector<HaplyDescription> haplyDevices(std::string_view json, bool* hasGrips = nullptr);

/// What a service says of a device in each answer, in our frame.
struct HaplyState {
    glm::dvec3                position{};              ///< [m]
    std::optional<glm::dvec3> velocity{};              ///< [m/s]; empty: the answer does not say
    std::optional<glm::dvec3> rendered{};              ///< [N] that the service says it renders; empty: it does not say
    glm::dquat                orientation{1, 0, 0, 0}; ///< of a grip
    bool                      hasGrip    = false;
    std::uint32_t             buttons    = 0;
    bool                      calibrated = false, ready = false;
};

enum class HaplyVerdict : std::uint8_t {
    good,
    noDevice, ///< the message is good, and does not list the device
    garbled   ///< no JSON, or without a position, or with a number that is none
};

/// Takes an answer. What it omits stays as it was, but for the position.
/// \param state  changed only if the verdict is good
[[nodiscard]] HaplyVerdict takeHaplyState(std::string_view json, std::string_view id, HaplyState& state);

/// What an event of the service means for the device.
struct HaplyEvent {
    enum class Kind : std::uint8_t {
        nothing,
        gone,    ///< unplugged
        stopped, ///< it has taken the force, for a moment
        braked,  ///< it has taken the force until it is released
        released
    } kind            = Kind::nothing;
    const char* words = ""; ///< of static storage
};

/// Reads an event; one of another device means nothing.
[[nodiscard]] HaplyEvent haplyEvent(std::string_view json, std::string_view id);

} // namespace palp
