#pragma once
#include <cstdint>

#include <glm/vec3.hpp>

#include "device/haptic_device.h"
#include "engine/session/scene.h"

namespace palp {

/// Returns the bit of HapticState::buttons that is a scene's clutch; 0: it has none.
[[nodiscard]] inline std::uint32_t clutchBit(const Scene& scene) noexcept
{
    return scene.clutchButton > 0 ? 1U << unsigned(scene.clutchButton - 1) : 0U;
}

/// Holds the tool of the scene where it is while its user carries the device back to the middle of the workspace, as
/// one lifts a mouse and puts it down elsewhere. No force flows meanwhile; afterwards it engages anew. While the
/// device's place is not known the tool stays where it was, too.
///
///     tool = device + offset         the offset is what the device went while the clutch was held
///
/// \thread the servo's; allocates nothing
class Clutch {
public:
    /// \param button  of HapticState::buttons, one bit, which means nothing else then; 0: the device has no clutch
    explicit Clutch(std::uint32_t button = 0) noexcept : button_(button) {}

    /// Returns the state with the tool's place instead of the device's, and without the clutch's button.
    /// \param isAsked  the clutch is held by other means than that button
    HapticState step(HapticState state, bool isAsked) noexcept
    {
        const glm::dvec3 device   = state.position;
        const bool       hasPlace = state.homed && tellsPlace(state.fault);
        isHeld_                   = isAsked || state.clutched || (state.buttons & button_) != 0;
        state.buttons &= ~button_;
        if (isPlaced_ && (isHeld_ || !hasPlace)) {
            if (hasPlace) offset_ = tool_ - device;
            state.velocity = {};
        } else {
            tool_ = device + offset_;
        }
        state.position = tool_; // to the bit while it is held, as its replay has it
        isPlaced_      = isPlaced_ || hasPlace;
        return state;
    }

    [[nodiscard]] bool isHeld() const noexcept { return isHeld_; }

private:
    std::uint32_t button_;
    bool          isHeld_   = false;
    bool          isPlaced_ = false;  ///< a place is known that could be held
    glm::dvec3    offset_{}, tool_{}; ///< [m] in the device's frame
};

} // namespace palp
