#pragma once
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "device/haptic_device.h"

namespace palp {

/// Where a hand is at a time: [s] by the clock of exchange() -> [m] in the device's frame.
using HandPath = std::function<glm::dvec3(double)>;

/// A place on the way of a recorded hand.
struct PathPoint {
    double     time = 0;   ///< [s]
    glm::dvec3 position{}; ///< [m]
};

/// A recorded hand as a path: straight from point to point, at rest before the first and after the last.
/// \param start  [s] when it is at the first point
/// \throws Error if there is no point, one is not finite, or times do not rise
[[nodiscard]] HandPath replayed(std::vector<PathPoint> points, double start = 0);

/// A hand that goes along a path whatever the force: for replays, and for tests that need a known motion.
class ScriptedDevice : public HapticDevice {
public:
    /// \param path   called by exchange(), so it allocates nothing and is quick; what is not finite or throws is the
    ///               fault "kinematics", and the hand stays
    /// \param reach  [m] radius of the workspace; outside it HapticState::inBox is false
    /// \throws Error if there is no path, or the reach is none
    explicit ScriptedDevice(HandPath path, double reach = 1);

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override;
    void        close() noexcept override;
    HapticState exchange(const GovernedForce& force, double now) noexcept override;

private:
    HandPath         path_;
    HapticDeviceInfo info_;
    HapticState      state_;
};

} // namespace palp
