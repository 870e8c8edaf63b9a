#pragma once
#include <cstdint>
#include <vector>

#include "device/device_record.h"
#include "device/falcon/falcon_device.h"

namespace palp {

/// A Novint Falcon that is plugged in.
extern const DeviceRecord kFalconRecord;

inline constexpr DeviceOption kFalconCounts{
    "--falcon-counts", "counts per N m of a Falcon's motors, see palpate calibrate [4200]", DeviceOption::Kind::number,
    FalconMotors::kLeastCountsPerTorque, FalconMotors::kMostCountsPerTorque};
inline constexpr DeviceOption kFalconTimerOnly{
    "--falcon-timer-only", "does not try whether the Falcon's bridge is faster if it passes on each answer at once",
    DeviceOption::Kind::flag};
inline constexpr DeviceOption kFalconFirmware{"--falcon-firmware",
                                              "image that a Falcon needs after it was plugged in [FALCON_FIRMWARE]"};

/// Returns the settings that the options ask for, without the firmware.
/// \throws Error naming an option out of its bounds
[[nodiscard]] FalconDeviceSettings falconSettings(const DeviceRequest& request);

/// Reads the firmware that the options or FALCON_FIRMWARE name; empty if neither does.
/// \throws Error naming the file
[[nodiscard]] std::vector<std::uint8_t> falconFirmware(const DeviceRequest& request);

} // namespace palp
