#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "device/device_record.h"

namespace palp {

/// Looks for the haptic devices of this machine; each is opened and closed again.
[[nodiscard]] DeviceList listHaptics();

/// Returns the libraries that find devices in this build: "libusb-1.0 1.0.26, hidapi 0.13.1".
[[nodiscard]] std::string hapticSupport();

/// Returns the name of the window system: "Wayland", "X11", or empty without one.
[[nodiscard]] std::string displayName();

/// Measures how fast each device answers that can be asked, for half a second at zero force. One that does not answer
/// is told in its listing.
void measureExchanges(std::vector<DeviceListing>& devices);

[[nodiscard]] nlohmann::ordered_json jsonOf(const std::vector<DeviceListing>& devices);

} // namespace palp
