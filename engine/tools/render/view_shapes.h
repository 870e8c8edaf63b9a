#pragma once
#include <vector>

#include "engine/tools/render/view_scene.h"

namespace palp {

/// A corner of a triangle.
struct ShapeCorner {
    glm::dvec3 position{};      ///< [m]
    glm::dvec3 normal{0, 0, 1}; ///< outward [1]
    Rgb8       colour;
};

/// Returns the triangles of a scene's proxy, HIP, stylus, arrows and outline, three corners each.
[[nodiscard]] std::vector<ShapeCorner> shapesOf(const ViewScene& scene);

} // namespace palp
