#pragma once
#include "engine/core/grid.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// What is held in the plane of the sheet.
struct HeldInPlane {
    NodeField share{};     ///< of the nodes [1]: heldUpToBorder(), and ties; empty: nothing is held
    int       tied    = 0; ///< supports
    int       without = 0; ///< supports that the sheet surrounds, beside another one, and that are not tied
};

/// Ties supports that the sheet surrounds to the ground beyond the nearest border, in the plane alone.
///
/// Around a support that lies within the sheet, such as a pin, Airy's function is another one after each turn if a
/// force goes there from another support. Where a border is near, as behind pins along a rim, that hardly differs from
/// a support that reaches the border: the sheet between them, whose width is the support's, keeps its length, and
/// bends as it does. Tied are those that are no farther from a border than an eighth of the root of the sheet's area.
[[nodiscard]] HeldInPlane heldInPlane(const Patch& patch);

} // namespace palp
