#pragma once
#include <algorithm>
#include <optional>
#include <span>

#include "compute_shaders/shared/view_layout.h"
#include "engine/tools/render/annotation.h"
#include "engine/tools/render/surface_renderer.h"

// Internal to engine/tools/render.

namespace palp {

/// Pixels from the left and the top of a picture; the last ones are those before right and bottom. Empty: no pixels.
struct PixelRect {
    int left = 0, top = 0, right = 0, bottom = 0; ///< [px]

    [[nodiscard]] bool empty() const { return left >= right || top >= bottom; }
};

/// Returns the smallest rectangle that holds both.
[[nodiscard]] inline PixelRect unionOf(const PixelRect& a, const PixelRect& b)
{
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

/// The input of one picture.
struct SurfaceInput {
    shared::ViewFrame                   frame{};
    std::span<const shared::ViewSplat>  splats;
    std::size_t                         dots = 0; ///< number of splats, the last ones, that are dots at any detail
    std::span<const std::uint32_t>      faces;    ///< numbers of splats, three to a triangle; empty: splats are drawn
    std::span<const shared::ViewCorner> shapes;   ///< three to a triangle
    std::size_t    shining     = 0; ///< number of shapes, the first ones, that are seen through the surface
    Detail         detail      = Detail::fine;
    const Overlay* overlay     = nullptr; ///< of the picture's size; may be null
    bool           sameOverlay = false;   ///< to the byte, as in the picture before
    /// The part that differs from the picture drawn before; empty: draw all of it.
    std::optional<PixelRect> changed;
};

} // namespace palp
