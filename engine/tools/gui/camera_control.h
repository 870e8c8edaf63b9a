#pragma once
#include <chrono>
#include <optional>

#include "device/hid/space_mouse.h"
#include "engine/session/hand_path.h"
#include "engine/tools/gui/input.h"
#include "engine/tools/gui/panel_layout.h"
#include "engine/tools/gui/pick.h"

namespace palp {

/// Moves the camera by pointer and SpaceMouse, frames the object, and keeps it in what the panels leave free.
/// Invariant: a request to frame the object lasts until the size of the picture is known.
/// \thread the window's
class CameraControl {
public:
    /// \param camera      outlives this
    /// \param spaceMouse  the same; may be null
    CameraControl(Camera& camera, SpaceMouse* spaceMouse) : camera_(camera), spaceMouse_(spaceMouse) {}

    /// Lets the object fill the next picture.
    void frameObject() { framing_ = true; }
    /// Looks obliquely at a place, and frames the object.
    void resetView(const HandPlace& place);
    /// Looks from this side, and frames the object.
    /// \param toEye  unit vector from the object to the eye [1]
    void lookFrom(const glm::dvec3& toEye);

    /// Orbits, pans and zooms.
    /// \param paints  the left button belongs to the brush
    /// \param hit     place under the pointer; a double click makes it the pivot
    void followPointer(const WindowInput& input, bool paints, const std::optional<Hit>& hit);
    /// Moves the camera by the cap of a SpaceMouse.
    /// \return whether the camera has moved
    bool followSpaceMouse();

    /// Frames the object if that was asked for, and glides to the middle of the area that panels leave free.
    /// \param bounds   bounds of the object
    /// \param elapsed  time since the last picture [s]
    /// \param jumps    moves at once instead of gliding
    /// \return whether the camera has moved
    bool settle(const Bounds& bounds, const PictureArea& area, const glm::ivec2& size, double elapsed, bool jumps);

private:
    Camera&                               camera_;
    SpaceMouse*                           spaceMouse_;
    bool                                  framing_ = true;
    std::chrono::steady_clock::time_point asked_{}; ///< when the SpaceMouse was last asked
};

} // namespace palp
