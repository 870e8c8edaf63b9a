#pragma once
#include "device/device_record.h"
#include "device/haply/emulated_haply.h"
#include "device/line_device.h"
#include "engine/session/gripped_arm.h"

namespace palp {

/// An emulated Inverse Service with an Inverse3, gripped by a scripted hand.
extern const DeviceRecord kHaplyEmulatorRecord;

/// An Inverse3 in a scripted hand, emulated from the service's sockets to the arm. The driver is that of a real one. It
/// follows the clock of read(), virtual or real. When the clock starts again, so does the hand's path.
/// \thread as HapticDevice
class GrippedHaply : public HapticDevice {
public:
    /// \throws Error naming a setting out of its range, or where the path leaves the workspace
    explicit GrippedHaply(const GrippingHand& hand, const EmulatedHaplySettings& service = {},
                          const SimulatedArmSettings& arm = assumedArm());

    /// Returns an arm like an Inverse3's. Its mass and damping have not been published: 0.3 kg and 2 N s/m are assumed.
    [[nodiscard]] static SimulatedArmSettings assumedArm();

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return device_->info(); }

    void                      open() override { device_->open(); }
    void                      close() noexcept override { device_->close(); }
    HapticState               read(double now) noexcept override;
    void                      render(const GovernedForce& force) noexcept override { device_->render(force); }
    void                      light(std::uint8_t lights) noexcept override { device_->light(lights); }
    [[nodiscard]] const char* faultWords() const noexcept override { return device_->faultWords(); }

    [[nodiscard]] EmulatedHaply&      emulator() noexcept { return service_; } ///< \thread that of read()
    [[nodiscard]] const SimulatedArm& arm() const noexcept { return arm_; }    ///< \thread that of read()
    void letGo() noexcept { isHeld_ = false; } ///< the hand leaves the grip; \thread that of read()

private:
    [[nodiscard]] glm::dvec3 moved(const glm::dvec3& force, double dt);

    GrippingHand                hand_;
    SimulatedArm                arm_;
    double                      emulated_ = 0;  ///< [s] that the arm has gone
    double                      begun_    = 0;  ///< [s] of that clock when the servo's was 0
    double                      last_     = -1; ///< [s] of the servo's clock at the last read()
    bool                        isHeld_   = true;
    EmulatedHaply               service_;
    std::unique_ptr<LineDevice> device_;
};

} // namespace palp
