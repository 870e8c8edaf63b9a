#pragma once
#include <span>
#include <vector>

#include "engine/pipeline/patch.h"
#include "engine/tools/render/view_scene.h"

namespace palp {

/// Strokes along the principal directions of a surface.
struct CurvatureCrosses {
    std::vector<ViewSegment> bulging; ///< where it bulges to the finger along the stroke [m]
    std::vector<ViewSegment> hollow;  ///< where it is hollow along the stroke [m]
};

/// Returns the curvature that a patch bent with as crosses, spread evenly over its window: a stroke lies along a
/// principal direction, and is as long as the curvature is strong beside the strongest of the picture.
/// \param rest       positions of the cloud at rest [m]
/// \param positions  where its points are drawn [m], as many
/// \param normals    of the surface at rest [1], as many; their side does not matter
/// \return nothing for a patch that bent as a plate
[[nodiscard]] CurvatureCrosses curvatureCrosses(const Patch& patch, std::span<const glm::dvec3> rest,
                                                std::span<const glm::dvec3> positions,
                                                std::span<const glm::dvec3> normals);

} // namespace palp
