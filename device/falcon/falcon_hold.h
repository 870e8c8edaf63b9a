#pragma once
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "device/falcon/falcon_device.h"

namespace palp {

/// Measures how long a Falcon's firmware holds the last force when the host falls silent: what protects the hand where
/// no program can, such as with the cable pulled out.
///
/// The motors carry arm and mass (FalconCalibration has just ended, hands off). Then nothing is sent for a time T, and
/// the next answer says how far the grip fell: s = a (T - hold)^2 / 2. T grows from 10 ms in steps of 5 ms, later of a
/// tenth, 20 ms at most. At the first fall beyond 0.1 mm it goes back by its last step and on in steps of 5 ms, until
/// the grip fell by more than 1.5 mm, or to 0.5 s; the straight line through the square roots of s meets zero at the
/// hold. An exchange is a millisecond, so that is the resolution. The drop is some millimetres.
/// \thread one
class FalconHold {
public:
    /// \param carries  [N] the force that carries the grip now
    /// \param up       [1] against gravity, in the device's frame
    explicit FalconHold(const glm::dvec3& carries, const glm::dvec3& up = {0, 1, 0});

    /// Does one tick.
    /// \param gain  [1] of the governor; below 1 nothing is measured
    /// \param dt    [s] since the last tick
    /// \return the force wanted [N], for the governor
    glm::dvec3 step(FalconDevice& device, const HapticState& state, double gain, double dt) noexcept;

    [[nodiscard]] bool isDone() const noexcept { return isDone_; }
    [[nodiscard]] bool fell() const noexcept { return isNear_; } ///< the grip, in one of the silences so far

    /// Returns the hold [s] once done; empty if the grip did not fall in 0.5 s, or not as a grip falls.
    [[nodiscard]] std::optional<double> hold() const noexcept;

private:
    struct Fall {
        double silence; ///< [s] between the answers before and after
        double root;    ///< [m^0.5] of the fall
    };

    void end(const HapticState& state) noexcept;

    glm::dvec3        integral_; ///< [N]
    glm::dvec3        up_;
    glm::dvec3        anchor_{}; ///< [m] the place to hold
    bool              isAnchored_ = false, isSilent_ = false, isDone_ = false;
    double            settled_ = 0;     ///< [s] since the last fall
    double            silence_ = 10e-3; ///< [s] the next
    double            step_    = 0;     ///< [s] by which it is longer than the one before
    bool              isNear_  = false; ///< the grip has fallen
    double            waited_  = 0;     ///< [s] since the silence began
    HapticState       before_{};
    std::vector<Fall> falls_;
};

} // namespace palp
