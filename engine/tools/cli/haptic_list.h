#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "device/device_record.h"

namespace palp {

/// Looks for the haptic devices of this machine, each of which is opened and let go again.
[[nodiscard]] DeviceList listHaptics();

/// What this build finds devices by: "libusb-1.0 1.0.26, hidapi 0.13.1".
[[nodiscard]] std::string hapticSupport();

/// The name of the window system: "Wayland", "X11", or empty without one.
[[nodiscard]] std::string displayName();

[[nodiscard]] nlohmann::ordered_json jsonOf(const std::vector<DeviceListing>& devices);

} // namespace palp
