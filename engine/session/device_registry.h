#pragma once
#include <span>
#include <string>
#include <string_view>

#include "device/device_record.h"

namespace palp {

/// Returns every kind of device that can be a session's hand, in the order of lists and help texts.
[[nodiscard]] std::span<const DeviceRecord* const> deviceRecords() noexcept;

/// Returns the record of a device as `--hand` names it: by the record's name, after which '@' or ':' and a path may
/// stand; null if that names no device.
[[nodiscard]] const DeviceRecord* deviceNamed(std::string_view hand) noexcept;

/// Returns "1-2.3" of "falcon@1-2.3", "udp:5005" of "bridge:udp:5005"; empty without '@' or ':'.
[[nodiscard]] std::string devicePath(std::string_view hand);

/// Checks the options given for a hand.
/// \param hand  as `--hand` has it; may name no device
/// \throws Error if an option is not one of the device's, or is out of its bounds
void demandOptionsOf(std::string_view hand, const DeviceOptionValues& options);

} // namespace palp
