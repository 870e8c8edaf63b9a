#include "device/device_list.h"

#include <algorithm>
#include <utility>

#include "device/hid/hid_bridge.h"
#include "device/hid/space_mouse_report.h"

namespace palp {
namespace {

/// Whether it can be opened, by opening it.
void tryIt(HidSystem& hid, DeviceListing& device)
{
    try {
        static_cast<void>(hid.open(device.path));
        device.usable = true;
    } catch (const HidRefused& refused) {
        device.why  = refused.why;
        device.help = refused.help;
    }
}

} // namespace

std::vector<DeviceListing> listDevices(HidSystem& hid, std::vector<DeviceListing> others)
{
    std::vector<DeviceListing> devices = std::move(others);
    for (const HidListing& listing : hid.list()) {
        const SpaceMouseModel* spaceMouse = spaceMouseModel(listing);
        if (!spaceMouse && !isBridge(listing)) continue;
        if (std::ranges::find(devices, listing.path, &DeviceListing::path) != devices.end()) continue;
        DeviceListing device{.name  = spaceMouse ? "spacemouse" : "bridge",
                             .model = spaceMouse ? spaceMouse->name : listing.model,
                             .path  = listing.path};
        tryIt(hid, device);
        devices.push_back(std::move(device));
    }
    devices.push_back({.name = "mouse", .model = "a pointer in the window, without force", .usable = true});
    devices.push_back({.name = "arm", .model = "a simulated arm like the Falcon's", .usable = true});
    devices.push_back(
        {.name = "falcon-emulator", .model = "a Falcon emulated down to its wire, in a scripted hand", .usable = true});
    return devices;
}

} // namespace palp
