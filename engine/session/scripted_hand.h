#pragma once
#include "device/haptic_device.h"
#include "engine/force/ahead.h"
#include "engine/session/hand_path.h"

namespace palp {

/// Plays a scripted or recorded hand as a device that no force moves. It is always open.
/// \thread as HapticDevice
class ScriptedHand : public HapticDevice {
public:
    /// \param hand  outlives this; its first waypoint is where the hand is at time 0
    explicit ScriptedHand(const HandPath& hand);

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override {}
    void        close() noexcept override {}
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& /*force*/) noexcept override {} ///< moves nothing

private:
    const HandPath&  hand_;
    HapticDeviceInfo info_;
    RecentMotion     motion_;
    std::uint64_t    sequence_ = 0;
};

} // namespace palp
