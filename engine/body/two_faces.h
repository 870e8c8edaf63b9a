#pragma once
#include "engine/cloud/soft_object.h"

namespace palp {

/// Returns whether the points of an object are those of a sheet's two faces, not of one surface: more than a tenth of
/// them have, straight behind, others as far away as the sheet is thick, or up to 2.5 times, that face the other way or
/// have no side.
/// \thread pure; takes milliseconds
[[nodiscard]] bool hasTwoFaces(const SoftObject& object);

} // namespace palp
