#include "device/device_record.h"

#include <algorithm>
#include <utility>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp {

double numberOf(const DeviceOption& option, const std::string& text)
{
    const std::string flag(option.flag);
    const double      value = parseQuantity(text, Dimension::none, flag);
    if (value >= option.least && value <= option.most) return value;
    const auto whole = [](double bound) { return std::to_string(static_cast<long long>(bound)); };
    throw Error(flag + ": expected " + whole(option.least) + " to " + whole(option.most) + ", found " + text);
}

std::string textOf(const DeviceOptionValues& values, const DeviceOption& option)
{
    const auto found = values.find(option.flag);
    return found == values.end() ? std::string() : found->second;
}

DeviceList listDevices(std::span<const DeviceRecord* const> records, HidSystem& hid)
{
    DeviceList list;
    for (const DeviceRecord* record : records) {
        std::vector<DeviceListing> found{{.usable = true}};
        try {
            if (record->list)
                found = record->list(hid);
            else if (record->calibration)
                found[0].calibration = record->calibration();
        } catch (const Error& error) { // two kinds may fail for the same reason
            found.clear();
            if (std::ranges::find(list.troubles, error.what()) == list.troubles.end())
                list.troubles.emplace_back(error.what());
        }
        for (DeviceListing& device : found) {
            device.name = record->name;
            if (device.model.empty()) device.model = record->model;
            list.devices.push_back(std::move(device));
        }
    }
    return list;
}

} // namespace palp
