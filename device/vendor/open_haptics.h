#pragma once
#include <functional>
#include <memory>
#include <string>

#include "device/device_record.h"
#include "device/line_device.h"
#include "device/machine_time.h"

namespace palp {

/// 3D Systems' Touch, Touch X and Omni through OpenHaptics, which the user brings.
extern const DeviceRecord kOpenHapticsRecord;

struct OpenHapticsSettings {
    std::string name{};              ///< of the device in their setup program; empty: the default one
    double      restToTry     = 0.5; ///< [s] at zero force after which forces are switched on again
    double      secondsToLook = 0.2; ///< [s] between looks whether the device is calibrated

    std::function<double()> clock = machineTime; ///< [s]; it never goes back
};

/// Makes the conversation with one device. The library is loaded by open(); its scheduler's thread makes the exchanges.
[[nodiscard]] std::unique_ptr<DeviceLine> makeOpenHapticsLine(const OpenHapticsSettings& settings = {});

/// Returns the limits of a model, as the library names it; those of a Touch if it is unknown.
[[nodiscard]] HapticDeviceInfo openHapticsInfo(const std::string& model);

} // namespace palp
