#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "device/device_list.h"

namespace palp {

/// What can serve as a hand on this machine, as the programs tell it.
struct HapticList {
    std::vector<DeviceListing> devices;
    std::vector<std::string>   troubles; ///< why some could not be looked for; one sentence each
};

/// Looks for them: Falcons and HID devices are opened and let go again.
[[nodiscard]] HapticList listHaptics();

/// What this build finds devices by: "libusb-1.0 1.0.26, hidapi 0.13.1".
[[nodiscard]] std::string hapticSupport();

/// Of the window system: "Wayland", "X11", or empty without one.
[[nodiscard]] std::string displayName();

[[nodiscard]] nlohmann::ordered_json jsonOf(const std::vector<DeviceListing>& devices);

} // namespace palp
