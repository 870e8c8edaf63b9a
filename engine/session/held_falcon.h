#pragma once
#include <optional>

#include "device/falcon/falcon_device.h"
#include "device/falcon/ft232_emulator.h"
#include "engine/session/held_arm.h"

namespace palp {

/// A Falcon in a hand, emulated from the packets on its wire to the arm; the driver is the one of a real Falcon. It
/// follows the clock of exchange(), virtual or real. \thread as HapticDevice
class HeldFalcon : public HapticDevice {
public:
    /// \throws Error naming a setting out of its range, or where the path leaves the workspace
    explicit HeldFalcon(const HoldingHand& hand, const Ft232EmulatorSettings& falcon = ready(),
                        const FalconDeviceSettings& device = {});

    /// A Falcon whose firmware runs and that is homed.
    [[nodiscard]] static Ft232EmulatorSettings ready();

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override { device_.open(); }
    void        close() noexcept override { device_.close(); }
    HapticState exchange(const GovernedForce& force, double now) noexcept override;
    void        light(std::uint8_t lights) noexcept override { device_.light(lights); }

    /// The hand leaves its path and holds the grip here instead: for homing. \param target  [m] device's frame
    void lead(const glm::dvec3& target) noexcept { led_ = target; }
    /// The hand goes along its path, from the start with the next exchange, whose clock may start anew.
    void follow() noexcept;

    [[nodiscard]] Ft232Emulator& emulator() noexcept { return emulator_; } ///< \thread that of exchange()

private:
    [[nodiscard]] glm::dvec3 moved(const glm::dvec3& force, double dt);

    HoldingHand               hand_;
    SimulatedArm              arm_;
    std::optional<glm::dvec3> led_;              ///< [m] where the hand is held, off its path
    double                    emulated_ = 0;     ///< [s] of the emulator's clock that the arm has gone
    double                    begun_    = 0;     ///< [s] of that clock when the session's was 0
    bool                      running_  = false; ///< exchange() was called since the path began
    std::uint32_t             pressed_  = 0;     ///< buttons of the path that are down
    Ft232Emulator             emulator_;
    FalconDevice              device_;
    HapticDeviceInfo          info_;
};

} // namespace palp
