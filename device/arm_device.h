#pragma once
#include "device/haptic_device.h"
#include "device/simulated_arm.h"

namespace palp {

/// A SimulatedArm, and the hand that holds it, as a device: read() moves both on to `now` by the caller's clock,
/// virtual or real. Its frame is the arm's. A force acts from render() on, after the delay of the settings.
///
/// If read() is not called, the force acts for 100 ms, then none; time beyond one second is omitted.
class ArmDevice : public HapticDevice {
public:
    /// \param start  [m] where the arm rests when it is opened
    /// \throws Error naming a setting out of its range
    explicit ArmDevice(const SimulatedArmSettings& settings = {}, const glm::dvec3& start = {});

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override;
    void        close() noexcept override;
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& force) noexcept override { wanted_ = force.newtons(); }

    /// Sets the hand from now on, see SimulatedArm::holdBy().
    /// \thread that of read(), or any while none runs
    void holdBy(const SimulatedHand& hand) noexcept;

    /// Returns the true position of the arm.
    /// \thread as holdBy()
    [[nodiscard]] const SimulatedArm& arm() const noexcept { return arm_; }

private:
    SimulatedArmSettings settings_;
    glm::dvec3           start_; ///< [m]
    SimulatedArm         arm_;
    SimulatedHand        hand_;
    HapticDeviceInfo     info_;
    HapticState          state_;
    glm::dvec3           wanted_{};       ///< [N] of the last render()
    bool                 ticked_ = false; ///< since open()
    double               last_   = 0;     ///< [s] of the last read()
};

} // namespace palp
