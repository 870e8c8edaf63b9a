#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "compute_shaders/shared/point_layout.h"
#include "engine/core/grid.h"

namespace palp {

/// The points that a plate gets its rigidity from.
struct PlatePoints {
    std::span<const ChartPoint> positions;   ///< [m]; may lie outside the grid
    std::span<const double>     rigidities;  ///< D of the same points [N m]
    ChartPoint                  corner;      ///< position of the grid's node (0, 0) [m]
    double                      spacing = 0; ///< mean distance of the cloud's points, at least 0 [m]
    double                      unit    = 1; ///< of the device's rigidities, the largest one or near it [N m]
};

/// Points sorted into buckets, as the shaders read them.
struct PointBuckets {
    shared::PointLayout                 layout{};
    std::vector<std::uint32_t>          starts; ///< by bucket, and one more: never more than max(points, 4) + 1
    std::vector<shared::ScatteredPoint> points; ///< by bucket, in each in their order
};

/// One to four points per bucket if they lie evenly. Positions are rounded to floats: by 4e-6 spacings at the far side
/// of 129 nodes.
/// \throws Error if there are no points, if one is not finite or more than 1e9 spacings away, or if a rigidity is not
///         positive, not finite or beyond what 32-bit arithmetic bears
/// \thread pure
[[nodiscard]] PointBuckets bucketPoints(const PlateGrid& grid, const PlatePoints& points);

} // namespace palp
