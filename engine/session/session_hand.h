#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/device_record.h"
#include "device/simulated_arm.h"
#include "engine/session/device_registry.h"
#include "engine/session/hand_path.h"
#include "engine/session/session_parts.h"

namespace palp {

/// The user's choice of a session's hand.
struct HandChoice {
    std::string                  hand   = "scan"; ///< press, circle, scan, a device of deviceRecords(), or a file
    double                       speed  = 0.05;   ///< [m/s] of a generated hand, at most
    double                       radius = 0.01;   ///< [m] of a circle; half the length of a scan
    std::optional<double>        depth{};         ///< [m] below the surface; empty: 40 % of the thickness
    std::optional<SimulatedHand> grip{};          ///< of a generated hand or a file, on a simulated device
    DeviceOptionValues           options{};       ///< of the device
    std::optional<double>        seconds{};       ///< empty: 5 s, or a file's own length

    std::function<void(std::size_t, std::size_t)> onUpload{};       ///< see DeviceRequest
    const std::atomic<bool>*                      cancel = nullptr; ///< see DeviceRequest
};

/// The hand of a session, with its device open.
struct SessionHand {
    std::unique_ptr<HidSystem>      hid;              ///< of the device; may be null
    std::unique_ptr<const HandPath> path;             ///< of a generated hand or a file; may be null
    const DeviceRecord*             record = nullptr; ///< null: the path moves by itself, whatever the force
    std::unique_ptr<HapticDevice>   device;
    DeviceFrame                     frame;
    std::optional<glm::dvec3>       from;        ///< [m] before the place, of a device that a person holds
    double                          seconds = 5; ///< [s] how long
    std::vector<std::string>        warnings;    ///< what is unusual about it, in sentences
    std::vector<std::string>        notes;       ///< what its user should know, in sentences

    /// Returns true if a person holds it, so that it runs in real time only.
    [[nodiscard]] bool isHeldByPerson() const noexcept { return record && record->holder == DeviceHolder::person; }
};

/// Refuses a word that is neither a hand nor a file that is there.
/// \param what    opens the complaint, before the word
/// \param folder  where a relative path begins; empty: the current folder
/// \throws Error naming the hands that there are, and the one that was likely meant
void demandKnown(const std::string& word, const std::string& what, const std::filesystem::path& folder = {});

/// Checks what the arguments alone show: the hand's name and the options of its device. Opening a device shows if it
/// is plugged in.
/// \throws Error naming `--hand` or the option
void demandGood(const HandChoice& choice);

/// Checks only whether the options are those of the hand.
/// \throws Error naming the option
void demandFitting(const HandChoice& choice);

/// Makes the hand and opens its device.
/// \throws Error naming the option, the file, or why the device cannot be used
[[nodiscard]] SessionHand openHand(const HandChoice& choice, const Scene& scene, const SoftObject& object);

} // namespace palp
