#pragma once
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns by how much what is felt may be off because a moved patch is pressed away from the middle of its window [1].
///
/// What is curved both ways has no chart with all lengths. Of the azimuthal one about the contact those from it are
/// right, and with them the moments of the finger's force. One about another place, s away, stretches lengths at a
/// distance d from the contact by K/4 s d beside those at the contact itself, K the Gaussian curvature. A share of the
/// bending energy counts by that, and what is felt by the fifth power of lengths, as of a gutter's width. Of caps that
/// are held at one side (R 60 to 120 mm, 1 mm thick, touched 5 to 34 mm from the middle) that is what they are felt too
/// soft by, 3 to 31 %, to a third of it; windows about the contact are within 5 % of CalculiX. Domes that are held all
/// around hardly bend far from the finger: there this says 3 % of what is off by 0 to 4.
/// \return 0 of a patch that was not moved, that is flat, or that has no response yet
[[nodiscard]] double chartDoubt(const Patch& patch);

} // namespace palp
