#include "engine/tools/cli/haptic_list.h"

#include <cstdlib>

#include "device/hid/hidapi_system.h"
#include "engine/session/device_registry.h"

namespace palp {
namespace {

bool isSet(const char* variable)
{
    const char* value = std::getenv(variable);
    return value && *value;
}

} // namespace

DeviceList listHaptics()
{
    HidapiSystem hid;
    DeviceList   list = listDevices(deviceRecords(), hid);
    for (DeviceListing& device : list.devices) {
        const DeviceRecord* record = deviceNamed(device.name);
        if (!record || record->holder != DeviceHolder::pointer || !displayName().empty()) continue;
        device.usable = false; // the device is a window's pointer
        device.why    = "there is no display";
        device.help   = "run it on a desktop, or with DISPLAY or WAYLAND_DISPLAY set";
    }
    return list;
}

std::string hapticSupport()
{
    std::string libraries;
    for (const DeviceRecord* record : deviceRecords()) {
        if (!record->support) continue;
        const std::string library = record->support().library;
        if (libraries.find(library) == std::string::npos) libraries += (libraries.empty() ? "" : ", ") + library;
    }
    return libraries;
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
                        {"help", orNull(device.help)},
                        {"calibration", orNull(device.calibration)}});
    return list;
}

} // namespace palp
