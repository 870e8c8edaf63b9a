#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "device/haptic_device.h"
#include "engine/core/enum_names.h"
#include "engine/session/tick_record.h"

namespace palp {

/// Whether forces may flow in a tick, and if not why. The last that applies counts.
enum class ForceState : std::uint8_t {
    flows,        ///< whatever the hand touches it feels
    comesOn,      ///< it feels a share, for 1.5 s
    waits,        ///< for a hand that is slow and presses on nothing
    plateSilent,  ///< the plate's answer is too old
    outOfBox,     ///< the grip is out of the device's workspace
    clutched,     ///< the clutch holds the tool while the device moves
    notHomed,     ///< the device does not know where the grip is
    programStops, ///< Ctrl-Z: the session lets go before
    deviceFaulty, ///< the device reports a fault that may pass
    stopped,      ///< by a fault of the governor, until the operator resets it
    deviceLost    ///< unplugged, or its link is lost: the session ends
};
constexpr auto namesOf(ForceState)
{
    using enum ForceState;
    return std::to_array<NamedValue<ForceState>>({{flows, "flows"},
                                                  {comesOn, "comes-on"},
                                                  {waits, "waits"},
                                                  {plateSilent, "plate-silent"},
                                                  {outOfBox, "out-of-box"},
                                                  {notHomed, "not-homed"},
                                                  {clutched, "clutched"},
                                                  {programStops, "program-stops"},
                                                  {deviceFaulty, "device-faulty"},
                                                  {stopped, "stopped"},
                                                  {deviceLost, "device-lost"}});
}

/// Returns the state of the forces in a tick.
[[nodiscard]] ForceState forceState(const TickRecord& record) noexcept;

/// Returns it for a person, with what to do: "no force: the grip is out of its workspace". Empty while forces flow.
/// \param words  of the device about its fault, as HapticDevice::faultWords(); empty: what is known of every device
[[nodiscard]] std::string describeForces(const TickRecord& record, std::string_view words = {});

/// Returns what a fault of a device means, as the end of a sentence: "it does not answer; see its cable and its power".
[[nodiscard]] std::string_view meaningOf(DeviceFault fault) noexcept;

/// Returns the light that shows it: red, home the device; blue, no force; green, forces flow or come on.
[[nodiscard]] DeviceLight lightOf(ForceState state) noexcept;

} // namespace palp
