#pragma once
#include <span>

#include <glm/vec3.hpp>

#include "engine/pipeline/patch.h"

namespace palp {

/// Gives points that the chart lays beside the window, but that go along with what lies in it, the place they go along
/// with; call it once the rigidity is resampled, where they do not count.
///
/// They are the other face of a thin body, which was unrolled around the rim: it moves with the face that lies over it,
/// not much farther off than the sheet is thick. And they are what hangs over a free edge of the window by less than the
/// thickness, as the round rim of a lobe does: nothing holds it back.
/// \param normals  of the touched points [1], towards the finger; empty where all of them face it
/// \thread pure
void carryAlong(Patch& patch, const SoftObject& object, std::span<const glm::dvec3> normals);

} // namespace palp
