#pragma once
#include <memory>
#include <optional>

#include "device/mouse_device.h"
#include "engine/session/session_parts.h"
#include "engine/tools/gui/pick.h"

namespace palp {

/// The pointer of a window as a hand: it presses the place under the pointer, as deep below the surface as the wheel
/// sets, and leaves it when it is released.
/// \thread the window's
class PointerHand {
public:
    /// \param start   where it hovers first
    /// \param height  above the surface while it hovers [m]
    /// \param bounds  bounds of the object, which limit its reach
    PointerHand(const Hit& start, double height, const Bounds& bounds);

    [[nodiscard]] HapticDevice& device() noexcept { return *device_; }
    [[nodiscard]] DeviceFrame   frame() const noexcept { return {origin_}; }

    /// Presses at a place, or continues to press at another.
    /// \param depth  below the surface [m]
    /// \return false if the object may lie between the hand and the place; nothing has changed, call begin() there
    [[nodiscard]] bool press(const Hit& at, double depth);

    /// Lets the hand begin anew, hovering over a place.
    /// \pre no session runs
    void begin(const Hit& at);

    /// Presses or releases the device's button, which declares the place in a hunt. Costs nothing if nothing changes.
    void mark(bool down);

    /// Releases the surface: the hand springs back to where it hovers.
    void release();

    /// Returns the place where the hand is, or hovers.
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
