#include "engine/chart/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/chart/detail/log_mean.h"
#include "engine/chart/nearest_map.h"

namespace palp {
namespace {

/// Takes the rigidity of the nearest point where there is no mean yet; returns the number of nodes without a point
/// nearby.
void takeNearest(const PatchWindow& window, std::span<const ChartPoint> positions, std::span<const double> rigidities,
                 double nearby, Resampled& result)
{
    const PlateGrid&                 grid    = window.grid;
    const std::vector<std::uint32_t> nearest = nearestPoint(grid, window.corner, positions);
    std::size_t                      n       = 0;
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j, ++n) {
            const ChartPoint& point = positions[nearest[n]];
            const double      x     = point.x - window.corner.x - i * grid.spacingX;
            const double      z     = point.z - window.corner.z - j * grid.spacingZ;
            result.nodesWithoutPoint += x * x + z * z > nearby * nearby;
            double& rigidity = result.rigidity.values()[n];
            if (std::isnan(rigidity)) rigidity = rigidities[nearest[n]];
        }
}

/// Fills the nodes that have no mean yet with those over wider squares.
void fillFromWider(const PatchWindow& window, std::span<const ChartPoint> positions, std::span<const double> rigidities,
                   double width, Resampled& result)
{
    const LogMeanSums   sums(window, positions, rigidities, width);
    const auto          nodes = std::size_t(window.grid.nodesZ());
    std::vector<double> row(nodes);
    for (int i = 0; i < window.grid.nodesX(); ++i) {
        sums.means(i, row);
        double* to = &result.rigidity.values()[std::size_t(i) * nodes];
        for (std::size_t j = 0; j < nodes; ++j)
            if (std::isnan(to[j])) to[j] = row[j];
    }
}

bool areFinite(std::span<const ChartPoint> positions)
{
    double zero = 0; // not a number as soon as one is not finite
    for (const ChartPoint& p : positions) zero += (p.x - p.x) + (p.z - p.z);
    return zero == 0;
}

} // namespace

PatchWindow PatchWindow::square(double size, int cells)
{
    PALP_EXPECT(size > 0 && std::isfinite(size), "size of the patch window " + std::to_string(size) + " m");
    PALP_EXPECT(cells >= 2 && cells % 2 == 0, std::to_string(cells) + " cells; the contact must be a node");
    return {{cells, cells, size / cells, size / cells}, {-size / 2, -size / 2}};
}

bool PatchWindow::holds(const ChartPoint& p) const noexcept
{
    return p.x >= corner.x && p.x <= corner.x + grid.sizeX() && p.z >= corner.z && p.z <= corner.z + grid.sizeZ();
}

double kernelReach(double pointSpacing, double nodeSpacing) noexcept
{
    return kResamplingReach * resamplingWidth(pointSpacing, nodeSpacing);
}

Resampled resampleRigidity(const PatchWindow& window, std::span<const ChartPoint> positions,
                           std::span<const double> rigidities, Resampling resampling, double pointSpacing,
                           double sparsest)
{
    PALP_EXPECT(!positions.empty() && positions.size() == rigidities.size(),
                std::to_string(positions.size()) + " positions, " + std::to_string(rigidities.size()) + " rigidities");
    const PlateGrid& grid  = window.grid;
    const double     cell  = std::max(grid.spacingX, grid.spacingZ);
    const double     width = resamplingWidth(pointSpacing, cell),
                 widest    = resamplingWidth(std::max(pointSpacing, sparsest), cell);

    PALP_EXPECT(areFinite(positions), "a point is not finite");

    Resampled result{NodeField(grid, std::numeric_limits<double>::quiet_NaN()), 0};
    if (resampling == Resampling::logMean) {
        const LogMeanSums sums(window, positions, rigidities, width);
        const auto        nodes = std::size_t(grid.nodesZ());
        for (int i = 0; i < grid.nodesX(); ++i)
            sums.means(i, std::span(result.rigidity.values()).subspan(std::size_t(i) * nodes, nodes));
        if (surelyCovered(window, positions, width)) return result;
        for (double wider = 2 * width; wider < 2 * widest; wider *= 2)
            fillFromWider(window, positions, rigidities, std::min(wider, widest), result);
    }
    takeNearest(window, positions, rigidities, kResamplingNearby * widest, result);
    return result;
}

} // namespace palp
