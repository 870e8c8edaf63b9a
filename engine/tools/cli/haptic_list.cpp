#include "engine/tools/cli/haptic_list.h"

#include <cstdlib>

#include "device/falcon/libusb_link.h"
#include "device/hid/hidapi_system.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

bool isSet(const char* variable)
{
    const char* value = std::getenv(variable);
    return value && *value;
}

std::vector<DeviceListing> falcons()
{
    std::vector<DeviceListing> list;
    for (const FalconListing& falcon : listFalcons())
        list.push_back({.name   = "falcon",
                        .model  = "Novint Falcon",
                        .path   = falcon.path,
                        .usable = falcon.usable,
                        .why    = falcon.why,
                        .help   = falcon.help});
    return list;
}

/// What `look` finds; a trouble if it fails.
template <class Look>
std::vector<DeviceListing> tried(Look look, std::vector<std::string>& troubles)
{
    try {
        return look();
    } catch (const Error& error) {
        troubles.emplace_back(error.what());
        return {};
    }
}

} // namespace

HapticList listHaptics()
{
    HapticList   list;
    HidapiSystem hid;
    const auto   usb = tried(falcons, list.troubles);
    list.devices     = tried([&] { return listDevices(hid, usb); }, list.troubles);
    if (list.devices.empty()) list.devices = usb; // HID could not be listed
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
    return falconSupport() + ", " + hidSupport();
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
