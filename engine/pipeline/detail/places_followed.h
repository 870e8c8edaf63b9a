#pragma once
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/pipeline/patch.h"

namespace palp {

/// Returns the place in the chart whose deflection each of the patch's points has [m]: mostly its own. Two kinds of
/// points follow another one.
///
/// The other face of a thin body, where it was unrolled around the rim, follows the face straight over it: points that
/// face away from the finger and lie 2.5 thicknesses at most under the fitted surface. And what hangs over a free edge
/// of the window by less than the thickness, as the round rim of a lobe does, follows the edge: nothing holds it back.
/// \param normals  of the touched points [1], towards the finger; empty where all of them face it
/// \thread pure
[[nodiscard]] std::vector<ChartPoint> placesFollowed(const Patch& patch, const SoftObject& object,
                                                     std::span<const glm::dvec3> normals);

} // namespace palp
