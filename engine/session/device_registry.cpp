#include "engine/session/device_registry.h"

#include <algorithm>
#include <array>

#include "device/falcon/falcon_record.h"
#include "device/haply/haply_record.h"
#include "device/hid/hid_records.h"
#include "device/mouse_device.h"
#include "device/vendor/force_dimension.h"
#include "device/vendor/open_haptics.h"
#include "engine/core/contract.h"
#include "engine/session/gripped_arm.h"
#include "engine/session/gripped_falcon.h"
#include "engine/session/gripped_haply.h"

namespace palp {
namespace {

constexpr std::array kRecords{&kFalconRecord,         &kHaplyRecord,        &kForceDimensionRecord, &kOpenHapticsRecord,
                              &kBridgeRecord,         &kSpaceMouseRecord,   &kMouseRecord,          &kArmRecord,
                              &kFalconEmulatorRecord, &kHaplyEmulatorRecord};

const DeviceOption* optionOf(const DeviceRecord& record, std::string_view flag) noexcept
{
    const auto found = std::ranges::find(record.options, flag, &DeviceOption::flag);
    return found == record.options.end() ? nullptr : &*found;
}

/// Returns the devices that have an option: "falcon or falcon-emulator".
std::string ownersOf(std::string_view flag)
{
    std::string owners;
    for (const DeviceRecord* record : kRecords)
        if (optionOf(*record, flag)) owners += (owners.empty() ? "" : " or ") + std::string(record->name);
    return owners;
}

} // namespace

std::span<const DeviceRecord* const> deviceRecords() noexcept
{
    return kRecords;
}

const DeviceRecord* deviceNamed(std::string_view hand) noexcept
{
    const auto found = std::ranges::find(kRecords, hand.substr(0, hand.find_first_of("@:")), &DeviceRecord::name);
    if (found == kRecords.end()) return nullptr;
    return (*found)->list || hand == (*found)->name ? *found : nullptr; // others have no path
}

std::string devicePath(std::string_view hand)
{
    const std::size_t at = hand.find_first_of("@:");
    return at == std::string_view::npos ? std::string() : std::string(hand.substr(at + 1));
}

void demandOptionsOf(std::string_view hand, const DeviceOptionValues& options)
{
    const DeviceRecord* record = deviceNamed(hand);
    for (const auto& [flag, text] : options) {
        if (text.empty()) continue;
        const DeviceOption* option = record ? optionOf(*record, flag) : nullptr;
        if (!option)
            throw Error(flag + " is an option of --hand " + ownersOf(flag) + ", found --hand " + std::string(hand));
        if (option->kind == DeviceOption::Kind::number) static_cast<void>(numberOf(*option, text));
    }
}

} // namespace palp
