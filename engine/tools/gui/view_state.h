#pragma once
#include "engine/tools/render/touch_view.h"

namespace palp {

enum class Tool {
    touch, ///< the pointer carries the hand
    paint  ///< the pointer carries a brush of stiffness
};

/// The brush in the user's hand.
struct BrushChoice {
    static constexpr double kSmallest = 0.2e-3, kLargest = 0.1; ///< of a radius that the user chooses [m]

    double radius   = 5e-3;  ///< [m]
    double value    = 1e6;   ///< stiffness that is painted, in the cloud's own kind [Pa] or [N m]
    double strength = 0.5;   ///< share of the way to the value that one stroke goes, 0 to 1 [1]
    bool   smooths  = false; ///< smooths instead of painting
};

/// The user's choices of view and tool, changed by keys, by the mouse and by panels, and read by everything else.
struct ViewState {
    Camera    camera;
    TouchLook look;

    bool panels = true;  ///< are shown
    bool keys   = false; ///< the sheet of keys is shown
    bool texts  = true;  ///< title, colour bar, key and scale are shown
    bool blind  = false; ///< something is hidden in the object, and nothing may show where

    Tool        tool = Tool::touch;
    BrushChoice brush;
    double      pressDepth = 1e-3; ///< how far below the surface the pointer carries the hand [m]
};

} // namespace palp
