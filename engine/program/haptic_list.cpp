#include "engine/program/haptic_list.h"

#include <cstdlib>

#include "device/hid/hidapi_system.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

bool isSet(const char* variable)
{
    const char* value = std::getenv(variable);
    return value && *value;
}

} // namespace

HapticList listHaptics()
{
    HapticList   list;
    HidapiSystem hid;
    try {
        list.devices = listDevices(hid);
    } catch (const Error& error) {
        list.troubles.emplace_back(error.what());
    }
    for (DeviceListing& device : list.devices) {
        if (device.name != "mouse" || !displayName().empty()) continue;
        device.usable = false; // it lives in a window
        device.why    = "there is no display";
        device.help   = "run it on a desktop, or with DISPLAY or WAYLAND_DISPLAY set";
    }
    return list;
}

std::string hapticSupport()
{
    return hidSupport();
}

std::string displayName()
{
    return isSet("WAYLAND_DISPLAY") ? "Wayland" : isSet("DISPLAY") ? "X11" : "";
}

nlohmann::ordered_json jsonOf(const std::vector<DeviceListing>& devices)
{
    const auto orNull = [](const std::string& text) {
        return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
    };
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const DeviceListing& device : devices)
        list.push_back({{"name", device.name},
                        {"model", orNull(device.model)},
                        {"path", orNull(device.path)},
                        {"usable", device.usable},
                        {"why", orNull(device.why)},
                        {"help", orNull(device.help)}});
    return list;
}

} // namespace palp
