#pragma once
#include <memory>
#include <optional>

#include "device/mouse_device.h"
#include "engine/session/session_parts.h"
#include "engine/tools/gui/pick.h"

namespace palp {

/// The pointer of a window as a hand: over the place that the pointer is on, as deep below the surface as the wheel
/// says, and off it again when it is let go. \thread the window's
class PointerHand {
public:
    /// \param start   where it hovers first  \param height  above the surface while it hovers [m]
    /// \param bounds  of the object: how far it may have to go
    PointerHand(const Hit& start, double height, const Bounds& bounds);

    [[nodiscard]] HapticDevice& device() noexcept { return *device_; }
    [[nodiscard]] DeviceFrame   frame() const noexcept { return {origin_}; }

    /// Presses at a place, or goes on pressing at another.
    /// \param depth  below the surface [m]
    /// \return false: the object may lie between the hand and the place. Nothing has happened; begin() there
    [[nodiscard]] bool press(const Hit& at, double depth);

    /// The hand begins anew, hovering over a place. \pre no session runs
    void begin(const Hit& at);

    /// Holds the device's button down, or lets it go: in a hunt that declares the place. Costs nothing if nothing
    /// changes.
    void mark(bool down);

    /// Lets go: springs back to where it hovers.
    void release();

    /// Where it is, or hovers.
    [[nodiscard]] const Hit& at() const noexcept { return at_; }

    [[nodiscard]] bool pressing() const noexcept { return pressing_; }

private:
    [[nodiscard]] glm::dvec3 above(const Hit& hit, double height) const { return hit.point + height * hit.outward; }
    void                     target(const glm::dvec3& place);

    double                       height_; ///< [m]
    double                       reach_;  ///< [m]
    glm::dvec3                   origin_; ///< of the device's frame [m]
    Hit                          at_;     ///< where it is, or hovers
    bool                         pressing_ = false, marking_ = false;
    glm::dvec3                   target_{}; ///< [m]
    std::unique_ptr<MouseDevice> device_;
};

} // namespace palp
