#pragma once
#include <functional>
#include <memory>
#include <string>

#include "device/device_record.h"
#include "device/line_device.h"
#include "device/machine_time.h"

namespace palp {

/// Force Dimension's omega, delta, sigma and lambda, and a Falcon through their SDK, which the user brings.
extern const DeviceRecord kForceDimensionRecord;

inline constexpr DeviceOption kForceDimensionInit{
    "--forcedimension-init",
    "the arm may move by itself to find its stops, if it has not been reset: hands off until it rests",
    DeviceOption::Kind::flag};

struct ForceDimensionSettings {
    int    index         = 0;     ///< of the device, as the library counts them
    bool   mayInitialise = false; ///< the arm may move by itself when it is opened
    double mostErrors    = 75e-3; ///< [s] of calls that all fail, after which the link is lost
    double restToTry     = 0.5;   ///< [s] at zero force after which forces are switched on again

    std::function<double()> clock = machineTime; ///< [s]; it never goes back
};

/// Makes the conversation with one device. The library is loaded by open().
[[nodiscard]] std::unique_ptr<DeviceLine> makeForceDimensionLine(const ForceDimensionSettings& settings = {});

/// Returns the limits of a type of device, by the library's number for it; the weakest of each if it is unknown.
[[nodiscard]] HapticDeviceInfo forceDimensionInfo(int type);

} // namespace palp
