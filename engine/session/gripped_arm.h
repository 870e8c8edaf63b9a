#pragma once
#include "device/arm_device.h"
#include "device/device_record.h"
#include "engine/session/hand_path.h"
#include "engine/session/session_parts.h"

namespace palp {

/// A simulated arm, gripped by a scripted hand.
extern const DeviceRecord kArmRecord;

/// A scripted hand that grips a simulated device by a spring and a damper while it moves along a path: forces move the
/// grip, as they would with a person.
struct GrippingHand {
    const HandPath& path; ///< [m] of the scene, its first waypoint is where the hand is at time 0; outlives the device
    SimulatedHand   grip; ///< stiffness and damping: 150 N/m is relaxed, 500 firm; its target is ignored
    DeviceFrame     frame{};

    /// Returns the hand at a time [s] of the session, in the device's frame.
    /// \param weight  [N] of the arm. Like a person the hand holds it up until the session does, which is 1.5 s long;
    ///                else it would lie in the object when the session begins
    [[nodiscard]] SimulatedHand at(double time, const glm::dvec3& weight = {}) const noexcept;

    /// Returns how the grip is turned at a time [s] of the session, in the device's frame.
    [[nodiscard]] glm::dquat orientation(double time) const noexcept;

    /// Checks that the path stays within the device's reach.
    /// \throws Error naming the first time at which the path is farther than `radius` [m] from the frame's origin
    void demandWithin(double radius) const;
};

/// A simulated arm in a scripted hand. Gravity pulls it, and the session carries it.
/// \thread as HapticDevice
class GrippedArm : public HapticDevice {
public:
    /// \throws Error naming a setting out of its range, or where the path leaves the arm's workspace
    explicit GrippedArm(const GrippingHand& hand, const SimulatedArmSettings& arm = fallingArm());

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return arm_.info(); }

    void        open() override { arm_.open(); }
    void        close() noexcept override { arm_.close(); }
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& force) noexcept override { arm_.render(force); }

private:
    GrippingHand hand_;
    glm::dvec3   weight_; ///< [N]
    ArmDevice    arm_;
};

} // namespace palp
