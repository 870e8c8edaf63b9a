#pragma once
#include <vector>

#include "engine/tools/render/view_scene.h"

namespace palp {

/// A corner of a triangle.
struct ShapeCorner {
    glm::dvec3 position{};      ///< [m]
    glm::dvec3 normal{0, 0, 1}; ///< outward [1]
    Rgb8       colour;
    bool       shinesThrough = true; ///< is seen, faintly, where the surface hides it
};

/// Returns the triangles of a scene's proxy, HIP, stylus, arrows and lines, three corners each. Strokes of curvature,
/// which are many and cover a body's far side too, do not shine through the surface, and come last.
[[nodiscard]] std::vector<ShapeCorner> shapesOf(const ViewScene& scene);

} // namespace palp
