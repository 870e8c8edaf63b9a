#include "engine/tools/cli/haptic_list.h"

#include <chrono>
#include <cstdlib>

#include "device/hid/hidapi_system.h"
#include "engine/core/contract.h"
#include "engine/core/real_time.h"
#include "engine/session/device_registry.h"
#include "engine/tools/cli/commands.h"

namespace palp {
namespace {

bool isSet(const char* variable)
{
    const char* value = std::getenv(variable);
    return value && *value;
}

nlohmann::ordered_json jsonOf(const std::optional<ExchangeRate>& rate)
{
    if (!rate) return nullptr;
    return {{"per_second", rate->perSecond}, {"age_s", rate->age}, {"longest_s", rate->longest}};
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

void measureExchanges(std::vector<DeviceListing>& devices)
{
    constexpr double kSeconds = 0.5;
    HidapiSystem     hid;
    for (DeviceListing& listing : devices) {
        const DeviceRecord* record = deviceNamed(listing.name);
        if (!listing.answers || !record) continue;
        try {
            const auto device = record->make({.hid = hid, .path = listing.path});
            device->open();
            Metronome  metronome{std::chrono::milliseconds(1)};
            const auto start = metronome.wait();
            listing.exchange = measureExchanges(
                *device, kSeconds, [&] { return std::chrono::duration<double>(metronome.wait() - start).count(); });
        } catch (const Error& error) {
            listing.why +=
                (listing.why.empty() ? "" : "; ") + std::string("its rate was not measured: ") + error.what();
        }
    }
}

nlohmann::ordered_json jsonOf(const std::vector<DeviceListing>& devices)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const DeviceListing& device : devices)
        list.push_back({{"name", device.name},
                        {"model", orNull(device.model)},
                        {"path", orNull(device.path)},
                        {"usable", device.usable},
                        {"why", orNull(device.why)},
                        {"help", orNull(device.help)},
                        {"calibration", orNull(device.calibration)},
                        {"exchange", jsonOf(device.exchange)}});
    return list;
}

} // namespace palp
