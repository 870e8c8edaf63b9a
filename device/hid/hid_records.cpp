#include "device/hid/hid_records.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "device/hid/bridge_lines.h"
#include "device/hid/hid_bridge.h"
#include "device/hid/hidapi_system.h"
#include "device/hid/space_mouse.h"
#include "device/hid/space_mouse_report.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Lists each device that `modelOf` gives a model; one that is listed twice appears once.
template <class ModelOf>
std::vector<DeviceListing> listHid(HidSystem& hid, ModelOf modelOf)
{
    std::vector<DeviceListing> devices;
    for (const HidListing& listing : hid.list()) {
        const auto model = modelOf(listing);
        if (!model || std::ranges::find(devices, listing.path, &DeviceListing::path) != devices.end()) continue;
        DeviceListing device{.model = *model, .path = listing.path};
        try {
            static_cast<void>(hid.open(device.path));
            device.usable = true;
        } catch (const HidRefused& refused) {
            device.why  = refused.why;
            device.help = refused.help;
        }
        devices.push_back(std::move(device));
    }
    return devices;
}

/// Finds the first device that `modelOf` gives a model and that can be opened, else the first, whose opening then says
/// why not; or the one at the requested path.
template <class ModelOf>
HidListing listingFor(const DeviceRequest& request, ModelOf modelOf, const char* what)
{
    const auto mayOpen = [&](const HidListing& listing) {
        try {
            return request.hid.open(listing.path) != nullptr;
        } catch (const HidRefused&) {
            return false;
        }
    };
    std::vector<HidListing> all = request.hid.list();
    std::erase_if(all, [&](const HidListing& listing) {
        return (!request.path.empty() && listing.path != request.path) || !modelOf(listing);
    });
    const auto usable = all.size() < 2 ? all.begin() : std::ranges::find_if(all, mayOpen);
    if (!all.empty()) return std::move(usable == all.end() ? all.front() : *usable);
    throw Error(std::string("no ") + what + " is plugged in" + (request.path.empty() ? "" : " at " + request.path) +
                "; palpate devices lists what there is");
}

std::optional<std::string> modelOfBridge(const HidListing& listing)
{
    return isBridge(listing) ? std::optional(listing.model) : std::nullopt;
}

std::optional<std::string> modelOfSpaceMouse(const HidListing& listing)
{
    const SpaceMouseModel* model = spaceMouseModel(listing);
    return model ? std::optional<std::string>(model->name) : std::nullopt;
}

DeviceSupport support()
{
    return {hasHidSupport(), hidSupport(), "install libhidapi-dev and build Palpate anew"};
}

/// Without hidapi it still speaks over UDP and serial ports.
DeviceSupport bridgeSupport()
{
    return {true, hidSupport() + (hasHidSupport() ? "" : ", so over UDP and serial ports only"), ""};
}

} // namespace

const DeviceRecord kBridgeRecord{.name  = "bridge",
                                 .model = "a device that speaks the bridge's report",
                                 .list =
                                     [](HidSystem& hid) {
                                         auto devices = listHid(hid, modelOfBridge);
                                         for (DeviceListing& device : devices) device.answers = device.usable;
                                         return devices;
                                     },
                                 .make = [](const DeviceRequest& request) -> std::unique_ptr<HapticDevice> {
                                     if (const auto line = parseBridgeLine(request.path)) return makeLineBridge(*line);
                                     return std::make_unique<HidBridgeDevice>(
                                         request.hid, listingFor(request, modelOfBridge, "bridge"));
                                 },
                                 .support = bridgeSupport};

const DeviceRecord kSpaceMouseRecord{.name  = "spacemouse",
                                     .model = "a cap with six axes, without force",
                                     .list  = [](HidSystem& hid) { return listHid(hid, modelOfSpaceMouse); },
                                     .make  = [](const DeviceRequest& request) -> std::unique_ptr<HapticDevice> {
                                         return std::make_unique<SpaceMouse>(
                                             request.hid, listingFor(request, modelOfSpaceMouse, "SpaceMouse"));
                                     },
                                     .support = support};

} // namespace palp
