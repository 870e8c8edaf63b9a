#pragma once
#include <optional>

#include "device/device_record.h"
#include "device/falcon/falcon_device.h"
#include "device/falcon/ft232_emulator.h"
#include "engine/session/gripped_arm.h"

namespace palp {

/// An emulated Falcon, gripped by a scripted hand.
extern const DeviceRecord kFalconEmulatorRecord;

/// The serial number of the emulated Falcon: palpate calibrate --emulator stores what it finds by this number, and
/// kFalconEmulatorRecord uses it.
inline constexpr const char* kEmulatedFalconSerial = "EMULATED";

/// Returns how much of the emulated Falcon's arm weighs on the grip in truth [kg].
[[nodiscard]] double emulatedFalconArm();

inline constexpr DeviceOption kFalconCold{
    "--falcon-cold",
    "the emulated Falcon was plugged in a moment ago: it takes a firmware first, and the scripted hand homes it",
    DeviceOption::Kind::flag};

/// A Falcon in a scripted hand, emulated from the packets on its wire to the arm. The driver is that of a real Falcon.
/// It follows the clock of read(), virtual or real. When the clock starts again, so does the hand's path. Unless
/// FalconDeviceSettings::tune says otherwise, the driver knows its true weight.
/// \thread as HapticDevice
class GrippedFalcon : public HapticDevice {
public:
    /// \throws Error naming a setting out of its range, or where the path leaves the workspace
    explicit GrippedFalcon(const GrippingHand& hand, const Ft232EmulatorSettings& falcon = ready(),
                           const FalconDeviceSettings& device = {});

    /// Returns the settings of a Falcon whose firmware runs and that is homed.
    [[nodiscard]] static Ft232EmulatorSettings ready();

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override;
    void        close() noexcept override { device_.close(); }
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& force) noexcept override { device_.render(force); }
    void        light(std::uint8_t lights) noexcept override { device_.light(lights); }

    /// Makes the hand leave its path and home the Falcon: out, in as far as it goes, and back. The path begins then.
    void home() noexcept override { homingSince_ = emulated_; }

    /// Returns true while the hand has not come back from homing.
    [[nodiscard]] bool isBeingHomed() const noexcept { return homingSince_.has_value(); }

    [[nodiscard]] Ft232Emulator& emulator() noexcept { return emulator_; } ///< \thread that of read()

private:
    [[nodiscard]] glm::dvec3    moved(const glm::dvec3& force, double dt);
    [[nodiscard]] SimulatedHand handNow();

    GrippingHand          hand_;
    SimulatedArm          arm_;
    double                emulated_ = 0;     ///< [s] of the emulator's clock that the arm has gone
    double                begun_    = 0;     ///< [s] of that clock when the servo's was 0
    double                last_     = 0;     ///< [s] of the servo's clock at the last read()
    bool                  running_  = false; ///< read() was called
    std::optional<double> homingSince_;      ///< [s] of the emulator's clock; empty: the hand is on its path
    double                waited_  = 0;      ///< [s] that the path began after the servo's clock was 0
    std::uint32_t         pressed_ = 0;      ///< buttons of the path that are down
    Ft232Emulator         emulator_;
    FalconDevice          device_;
    bool                  isTuned_; ///< by FalconDeviceSettings::tune
    HapticDeviceInfo      info_;
};

} // namespace palp
