#pragma once
#include <optional>

#include "engine/tools/render/surface_input.h"

// Internal to engine/tools/render.

namespace palp {

/// Returns the part of a fast picture that may differ from the one before: during a touch little more than the dent.
/// In a software driver the time depends on the number of pixels drawn.
///
/// Both inputs are compared, so that callers need not record changes. Omitted parts of a picture would come out the
/// same to the byte.
/// \param now, before  are compared except for the overlay, whose changed squares the caller must add
/// \return nothing if all of it may differ, as after a motion of the camera; a rectangle without pixels if none of it
[[nodiscard]] std::optional<PixelRect> changedPart(const SurfaceInput& before, const SurfaceInput& now);

/// Returns the squares of two overlays that differ.
/// \pre both have one size
[[nodiscard]] PixelRect changedPart(const Overlay& before, const Overlay& now);

} // namespace palp
