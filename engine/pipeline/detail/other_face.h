#pragma once
#include <optional>
#include <vector>

#include "engine/chart/chart.h"
#include "engine/pipeline/detail/touched_surface.h"

namespace palp {

/// Returns, for each point of a piece that goes around the rim of a thin sheet, whether it lies on the face that is not
/// touched: unrolled, it would lie beside the touched one, and a lobe would be twice as large as it is.
///
/// Two points that face away from each other, one behind the other and not much farther apart than the sheet is thick,
/// are its two faces, and the one whose way along the surface is the shorter is touched. Where both ways are as long,
/// at the rim and behind a notch, it is the one that faces the finger. What has no other face so near, a tube or a
/// solid, stays.
/// \param places     in the chart [m], one for each point that has one
/// \param outward    of the chart [1] unit
/// \param thickness  of the sheet [m]
/// \thread pure
[[nodiscard]] std::vector<bool> onOtherFace(const TouchedSurface&                         surface,
                                            const std::vector<std::optional<ChartPoint>>& places,
                                            const glm::dvec3& outward, double thickness);

} // namespace palp
