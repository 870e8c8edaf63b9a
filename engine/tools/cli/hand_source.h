#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "device/falcon/falcon_device.h"
#include "device/hid/hid_port.h"
#include "engine/session/hand_path.h"
#include "engine/session/session_parts.h"

namespace palp {

/// What the command line says about a Falcon.
struct FalconOptions {
    std::string           firmware;               ///< empty: FALCON_FIRMWARE
    std::optional<double> countsPerTorque;        ///< of its motors [1/(N m)]; empty: FalconMotors::kCountsPerTorque
    bool                  eventCharacter = false; ///< see FalconStartSettings

    /// But for the firmware, which only a real one needs.
    [[nodiscard]] FalconDeviceSettings settings() const;
};

/// Adds --falcon-firmware, --falcon-counts and --falcon-event-character. Counts that no Falcon's motors have been seen
/// to need are refused, and NaN: 2000 to 10 000. With much too many the loop swings.
void addFalconOptions(CLI::App& command, FalconOptions& options);

/// What the command line says about the hand.
struct HandOptions {
    std::string   hand  = "scan"; ///< press, circle, scan, a file, or a device as `palpate devices` names it
    std::string   speed = "50 mm/s", depth, reach = "10 mm";
    std::string   grip; ///< of the hand that holds a simulated arm; empty: forces do not move the hand
    double        metresPerPlainNumber = 1; ///< of depth and reach, as of all lengths on the command line
    FalconOptions falcon;
    std::string   seconds; ///< "5 s"; empty: 5 s, or a file's own length
};

/// "5 s" or "5" [s]. \throws Error naming --seconds
[[nodiscard]] double secondsOf(const std::string& text);

/// A hand that is ready: its device is open.
struct HandSource {
    std::unique_ptr<HidSystem>      hid;  ///< of the device; may be null
    std::unique_ptr<const HandPath> path; ///< of a script or a file; null of a device that somebody holds
    std::unique_ptr<HapticDevice>   device;
    DeviceFrame                     frame;
    double                          seconds = 5; ///< how long [s]
    std::vector<std::string>        warnings;    ///< what is odd about it, in sentences

    [[nodiscard]] bool isHeld() const noexcept { return !path; } ///< by somebody, in real time
};

/// \throws Error naming the option, the file, or why the device cannot be used
[[nodiscard]] HandSource handFor(const HandOptions& options, const Scene& scene, const SoftObject& object);

/// What can be said of the options before a hand is there: its name, its numbers, a file that can be read. Whether a
/// device is plugged in shows when it is opened.
/// \throws Error naming the option
void demandGood(const HandOptions& options);

/// A Falcon that is plugged in, not opened yet. \param path  of its listing; empty: the first that is usable
/// \throws Error naming the image, if it cannot be read
[[nodiscard]] std::unique_ptr<HapticDevice> falconFor(const FalconOptions& options, const std::string& path = {});

/// Waits until somebody has homed the device. Devices that need none: nothing.
/// \param stop  gives up once it is true
/// \param tell  is told how, once that takes longer than a second
/// \return whether it had told
/// \throws Error if the device is lost, or `stop` came first
bool waitForHoming(HapticDevice& device, const std::atomic<bool>& stop,
                   const std::function<void(const std::string&)>& tell);

/// The same with words on standard error.
void waitForHoming(HapticDevice& device, const std::atomic<bool>& stop);

} // namespace palp
