#pragma once
#include <atomic>
#include <string>

#include <CLI/CLI.hpp>

#include "engine/session/session_hand.h"

namespace palp {

/// The options of the hand, as the command line gives them.
struct HandOptions {
    std::string        hand = "scan";             ///< as HandChoice::hand
    std::string        speed{}, depth{}, reach{}; ///< of a generated hand; empty: as HandChoice has them
    double             metresPerPlainNumber = 1;  ///< of depth and reach, see metresPerPlainNumber()
    std::string        grip{};    ///< of a scripted hand on a simulated device; empty: forces do not move the hand
    DeviceOptionValues device{};  ///< options of the device
    std::string        seconds{}; ///< "5 s"; empty: 5 s, or a file's own length

    const std::atomic<bool>* cancel = nullptr; ///< see DeviceRequest
};

/// Returns how a generated hand moves and how its arm is held, in SI units; the same words for the same motion.
/// \throws Error naming the option whose text is not understood
[[nodiscard]] std::string motionOf(const HandOptions& options);

/// Returns "press, circle, scan": the hands that Palpate generates.
[[nodiscard]] std::string generatedHands();

/// Returns "falcon, bridge, ...": the devices that a command without a window can use.
[[nodiscard]] std::string deviceHands();

/// Adds the options of generated hands (--speed, --press-depth, --reach, --arm) and those of these devices.
void addHandOptions(CLI::App& command, HandOptions& options, std::span<const DeviceRecord* const> records);

/// Adds every option of these devices.
void addDeviceOptions(CLI::App& command, DeviceOptionValues& values, std::span<const DeviceRecord* const> records);

/// Reads the length of a path to either side of the place [m].
/// \throws Error naming --reach
[[nodiscard]] double reachOf(const std::string& text, double metresPerPlainNumber);

/// Reads "5 s" or "5" [s].
/// \throws Error naming --seconds
[[nodiscard]] double secondsOf(const std::string& text);

/// Returns the hand that the options ask for, with its device open.
/// \throws Error naming the option, the file, or why the device cannot be used
[[nodiscard]] SessionHand handFor(const HandOptions& options, const Scene& scene, const SoftObject& object);

/// Checks what can be checked before the hand is opened: its name, its numbers, a file that can be read.
/// \throws Error naming the option
void demandGood(const HandOptions& options);

/// Checks whether the options are those of the hand, such as of the pointer, which a window has by itself.
/// \throws Error naming the option
void demandFitting(const HandOptions& options);

/// Waits until the user has homed the device, and says on standard error what to do.
/// \throws Error as the function of device/homing.h does
void waitForHoming(HapticDevice& device, const std::atomic<bool>& stop);

} // namespace palp
