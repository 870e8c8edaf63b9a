#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/device_check.h"
#include "device/exchange_rate.h"
#include "device/haptic_device.h"
#include "device/hid/hid_port.h"

// One record per kind of haptic device. The commands, their help and falcon_demo know devices by their records alone;
// engine/session/device_registry.cpp lists them.
namespace palp {

struct GrippingHand; // engine/session/gripped_arm.h; here it is only passed on

/// The mover of a device.
enum class DeviceHolder : std::uint8_t {
    person,       ///< a person moves it, so it runs in real time only
    pointer,      ///< the pointer of a window moves it
    scriptedHand, ///< a scripted hand grips it, see DeviceRequest::hand
    nobody        ///< it moves or rests by itself
};

/// A device that was found.
struct DeviceListing {
    std::string                 name{};         ///< name of its record; listDevices() fills it in
    std::string                 model{};        ///< "SpaceMouse Compact"; empty: the record's
    std::string                 path{};         ///< where it is plugged in; empty for simulations
    bool                        usable = false; ///< it can be opened now
    std::string                 why{};          ///< why it is not usable, or what it still needs; empty if it is ready
    std::string                 help{};         ///< one line that helps; may be empty
    std::string                 calibration{};  ///< what is known of its force; empty: its kind needs none
    std::optional<ExchangeRate> exchange{};     ///< how fast it answers; empty: not measured
    bool answers = false; ///< it can be opened and asked at zero force without sending it anything first
};

/// An option of a device on the command line.
struct DeviceOption {
    enum class Kind : std::uint8_t { number, text, flag };

    std::string_view flag; ///< "--falcon-counts"
    std::string_view help;
    Kind             kind  = Kind::text;
    double           least = 0, most = 0; ///< bounds of a number
};

/// The texts of options by their flags. The text of a Kind::flag is "true"; an empty text means that the option was not
/// given.
using DeviceOptionValues = std::map<std::string, std::string, std::less<>>;

/// \throws Error naming the option, its bounds and what was found
[[nodiscard]] double numberOf(const DeviceOption& option, const std::string& text);

/// Returns the text of an option; empty if it was not given.
[[nodiscard]] std::string textOf(const DeviceOptionValues& values, const DeviceOption& option);

/// The support of this build for a kind of device.
struct DeviceSupport {
    bool        isBuilt = true;
    std::string library; ///< "libusb-1.0 1.0.26", or "compiled without libusb-1.0"
    std::string help;    ///< how to build with it
};

/// The arguments from which a device is made.
struct DeviceRequest {
    HidSystem&                                    hid;            ///< of the HID devices; outlives the device
    DeviceOptionValues                            options{};      ///< only those of the record
    std::string                                   path{};         ///< path of a listing; empty: the first usable device
    const GrippingHand*                           hand = nullptr; ///< of DeviceHolder::scriptedHand; outlives make()
    std::function<void(std::size_t, std::size_t)> onUpload{};     ///< bytes of firmware sent so far, bytes in all
    const std::atomic<bool>* cancel = nullptr; ///< once true, opening may end with an error; outlives the device
};

/// All that a program must know of one kind of device.
struct DeviceRecord {
    std::string_view name;  ///< the word that `--hand` takes: "falcon"
    std::string_view model; ///< name for people: "Novint Falcon"
    DeviceHolder     holder = DeviceHolder::person;

    bool simulated = false; ///< it has no hardware

    std::span<const DeviceOption> options{};

    /// Lists the devices of this kind that are plugged in. Each is opened and closed again to see whether that works.
    /// Null: there is always one.
    /// \throws Error if the search fails
    std::vector<DeviceListing> (*list)(HidSystem& hid) = nullptr;

    /// Makes a device of this kind; HapticDevice::open() then opens it.
    /// \throws Error naming what is missing, or an option out of its bounds
    std::unique_ptr<HapticDevice> (*make)(const DeviceRequest& request) = nullptr;

    std::string (*calibration)() = nullptr; ///< DeviceListing::calibration of a device without `list`; may be null

    DeviceSupport (*support)()         = nullptr; ///< null: every build supports it
    std::vector<Finding> (*findings)() = nullptr; ///< checks its other needs on this machine; may be null
};

/// The result of listDevices().
struct DeviceList {
    std::vector<DeviceListing> devices;
    std::vector<std::string>   troubles; ///< why some could not be searched for; one sentence each
};

/// Looks for the devices of these records, in their order.
[[nodiscard]] DeviceList listDevices(std::span<const DeviceRecord* const> records, HidSystem& hid);

} // namespace palp
