#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "device/device_record.h"
#include "device/falcon/falcon_device.h"

namespace palp {

/// A Novint Falcon that is plugged in.
extern const DeviceRecord kFalconRecord;

inline constexpr DeviceOption kFalconCounts{
    "--falcon-counts", "counts per N m of a Falcon's motors [as palpate calibrate found, else 4200]",
    DeviceOption::Kind::number, FalconMotors::kLeastCountsPerTorque, FalconMotors::kMostCountsPerTorque};
inline constexpr DeviceOption kFalconTimerOnly{
    "--falcon-timer-only", "does not try whether the Falcon's bridge is faster if it passes on each answer at once",
    DeviceOption::Kind::flag};
inline constexpr DeviceOption kFalconFirmware{"--falcon-firmware",
                                              "image that a Falcon needs after it was plugged in [FALCON_FIRMWARE]"};

/// Returns the settings that the options ask for, without the firmware.
/// \throws Error naming an option out of its bounds
[[nodiscard]] FalconDeviceSettings falconSettings(const DeviceRequest& request);

/// Returns the counts per torque that the options give [counts/(N m)]; empty: none.
/// \throws Error if they are out of their bounds
[[nodiscard]] std::optional<double> countsByHand(const DeviceOptionValues& options);

/// Makes a Falcon for its calibration, which it begins as tuningToCalibrate() says.
/// \throws Error as DeviceRecord::make
[[nodiscard]] std::unique_ptr<FalconDevice> makeFalconToCalibrate(const DeviceRequest& request);

/// Reads the firmware that the options or FALCON_FIRMWARE name; empty if neither does.
/// \throws Error naming the file
[[nodiscard]] std::vector<std::uint8_t> falconFirmware(const DeviceRequest& request);

} // namespace palp
