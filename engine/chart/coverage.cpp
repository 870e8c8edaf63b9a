#include "engine/chart/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/chart/nearest_map.h"

namespace palp {
namespace {

double largestCell(const PlateGrid& grid)
{
    return std::max(grid.spacingX, grid.spacingZ);
}

/// Returns the distance of each node from the nearest point [m]; perhaps more, where it is more than `exact`.
NodeField distanceToPoints(const PatchWindow& window, std::span<const ChartPoint> positions, double exact)
{
    const PlateGrid& grid = window.grid;
    NodeField        distance(grid);
    const auto       nearest = nearestPoint(grid, window.corner, positions, exact);
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) {
            const ChartPoint& p = positions[nearest[std::size_t(i) * std::size_t(grid.nodesZ()) + std::size_t(j)]];
            distance(i, j) =
                std::hypot(p.x - window.corner.x - i * grid.spacingX, p.z - window.corner.z - j * grid.spacingZ);
        }
    return distance;
}

/// Returns how deep each node lies in the union of discs about the points, up to some depth; infinity where it is
/// deeper.
///
/// A node outside, e from that union, has no part of it within e, so that it is no deeper at any other node than their
/// distance less e; the best of those around gives the depth.
NodeField depthInDiscs(const PlateGrid& grid, const NodeField& distance, double radius, double deepest)
{
    const double cell  = largestCell(grid);
    const int    reach = int(std::ceil((deepest + 2 * cell) / std::min(grid.spacingX, grid.spacingZ)));
    NodeField    depth(grid, std::numeric_limits<double>::infinity());
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) {
            const double beyond = distance(i, j) - radius;
            if (!(beyond > 0 && beyond <= 2 * cell)) continue; // those farther out say nothing that these do not
            for (int k = std::max(0, i - reach); k <= std::min(grid.cellsX, i + reach); ++k)
                for (int l = std::max(0, j - reach); l <= std::min(grid.cellsZ, j + reach); ++l) {
                    const double away = std::hypot((k - i) * grid.spacingX, (l - j) * grid.spacingZ);
                    depth(k, l)       = std::min(depth(k, l), away - beyond);
                }
        }
    return depth;
}

} // namespace

NodeField depthWithin(const PatchWindow& window, std::span<const ChartPoint> positions, double pointSpacing,
                      double deepest)
{
    constexpr double kBeyond  = 0.5; // spacings from the last points to the border [1]
    const PlateGrid& grid     = window.grid;
    const double     radius   = closedGap(pointSpacing, largestCell(grid)) / 2;
    const double     shift    = radius - kBeyond * pointSpacing; // [m] from the discs' border inwards
    const NodeField  distance = distanceToPoints(window, positions, radius + 3 * largestCell(grid));
    NodeField        depth    = depthInDiscs(grid, distance, radius, deepest + shift);
    for (std::size_t n = 0; n < depth.values().size(); ++n) {
        const double beyond = distance.values()[n] - radius; // the discs' border
        depth.values()[n]   = (beyond > 0 ? -beyond : std::min(depth.values()[n], deepest + shift)) - shift;
    }
    return depth;
}

double closedGap(double pointSpacing, double cell) noexcept
{
    return 2 * kResamplingNearby * resamplingWidth(pointSpacing, cell);
}

NodeField coveredShare(const PlateGrid& grid, const NodeField& depth)
{
    NodeField share = depth;
    for (double& value : share.values()) value = std::clamp(0.5 + value / largestCell(grid), 0.0, 1.0);
    return share;
}

} // namespace palp
