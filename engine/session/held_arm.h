#pragma once
#include "device/arm_device.h"
#include "engine/session/hand_path.h"

namespace palp {

/// A simulated arm whose grip a hand holds by a spring and a damper, while the hand goes along a path: forces move it,
/// as they would a person. The middle of its workspace, the origin of its frame, is origin().
/// \thread as HapticDevice
class HeldArm : public HapticDevice {
public:
    /// \param path    outlives it; [m] of the scene, its first sample is where the hand is at time 0
    /// \param grip    how firmly: 150 N/m is relaxed, 500 firm; its target is ignored
    /// \param origin  [m] of the scene; DeviceFrame::origin of the session
    /// \throws Error naming a setting out of its range, or the path where it leaves the arm's workspace
    HeldArm(const HandPath& path, const SimulatedHand& grip, const glm::dvec3& origin,
            const SimulatedArmSettings& arm = {});

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return arm_.info(); }

    void        open() override { arm_.open(); }
    void        close() noexcept override { arm_.close(); }
    HapticState exchange(const GovernedForce& force, double now) noexcept override;

    [[nodiscard]] const glm::dvec3&   origin() const noexcept { return origin_; } ///< [m] of the scene
    [[nodiscard]] const SimulatedArm& arm() const noexcept { return arm_.arm(); } ///< where it truly is

private:
    const HandPath& path_;
    SimulatedHand   grip_;
    glm::dvec3      origin_; ///< [m]
    ArmDevice       arm_;
};

} // namespace palp
