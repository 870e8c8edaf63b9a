#pragma once
#include <span>

#include "engine/chart/resample.h"

namespace palp {

/// Returns how deep the nodes lie within the border of a sheet [m]: up to `deepest`, and below 0 beyond the border.
///
/// The border is that of the points' closing: the sheet is what no disc can reach that holds no point. The disc's
/// radius is 2.5 spacings, of the points or half of the nodes', whichever is larger, so that neither the gaps between
/// random points nor a raster of nodes fray it; holes that are narrower than the disc are closed. The border lies half
/// a spacing outside of that, because random points do not reach theirs.
/// \param positions     of the touched points in the chart [m], at least one
/// \param pointSpacing  mean distance of the points [m], where they are farthest apart
/// \differs the paper's patch has no border: its rigidity goes on, or ends with the window
/// \source  closing as in Serra 1982, "Image Analysis and Mathematical Morphology"; the distance from outside as in
///          Felzenszwalb and Huttenlocher 2012, restricted to the border's neighbourhood
[[nodiscard]] NodeField depthWithin(const PatchWindow& window, std::span<const ChartPoint> positions,
                                    double pointSpacing, double deepest);

/// Returns the width of the gaps in a sheet that depthWithin() closes [m].
[[nodiscard]] double closedGap(double pointSpacing, double cell) noexcept;

/// Returns the share of the sheet at the nodes [1]: 1 inside, 0 outside, and between them over one cell, half of it on
/// the border.
/// \param depth  of depthWithin(), with a cell and more as the deepest
[[nodiscard]] NodeField coveredShare(const PlateGrid& grid, const NodeField& depth);

} // namespace palp
