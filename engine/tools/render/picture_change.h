#pragma once
#include <optional>

#include "engine/tools/render/surface_input.h"

// Internal to engine/tools/render.

namespace palp {

/// The part of a fast picture in which it may differ from the one before: while a hand touches, little more than what
/// it dents, and a driver in software takes as long as it has pixels to draw.
///
/// Both are compared, so that nobody has to tell what has changed. Parts of a picture that this leaves out would come
/// out the same to the byte.
/// \param now, before  everything but the overlay, of which change in its squares is for the caller to add
/// \return nothing: all of it, as after the camera has moved; a rectangle without pixels: none of it
[[nodiscard]] std::optional<PixelRect> changedPart(const SurfaceInput& before, const SurfaceInput& now);

/// Of two overlays: the squares that differ. \pre of one size
[[nodiscard]] PixelRect changedPart(const Overlay& before, const Overlay& now);

} // namespace palp
