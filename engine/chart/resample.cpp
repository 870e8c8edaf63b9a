#include "engine/chart/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/chart/detail/log_mean.h"
#include "engine/chart/nearest_map.h"

namespace palp {
namespace {

/// Takes the values of the nearest point where there is no mean yet, and counts the nodes without a point nearby.
void takeNearest(const PatchWindow& window, std::span<const ChartPoint> positions, std::span<const PointValues> values,
                 double nearby, double exact, std::vector<Resampled>& results)
{
    const PlateGrid&                 grid    = window.grid;
    const std::vector<std::uint32_t> nearest = nearestPoint(grid, window.corner, positions, std::max(exact, nearby));
    std::size_t                      n = 0, without = 0;
    double                           bareFrom = std::numeric_limits<double>::infinity();
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j, ++n) {
            const ChartPoint& point = positions[nearest[n]];
            const double      x     = point.x - window.corner.x - i * grid.spacingX;
            const double      z     = point.z - window.corner.z - j * grid.spacingZ;
            if (x * x + z * z <= nearby * nearby) continue;
            ++without;
            bareFrom = std::min(
                bareFrom, std::hypot((i - 0.5 * grid.cellsX) * grid.spacingX, (j - 0.5 * grid.cellsZ) * grid.spacingZ));
        }
    for (std::size_t v = 0; v < values.size(); ++v) {
        results[v].nodesWithoutPoint = without;
        results[v].bareFrom          = bareFrom;
        std::vector<double>& nodes   = results[v].rigidity.values();
        for (n = 0; n < nodes.size(); ++n)
            if (std::isnan(nodes[n])) nodes[n] = values[v][nearest[n]];
    }
}

/// Fills the nodes that have no mean yet with those over squares of this width.
void fill(const PatchWindow& window, std::span<const ChartPoint> positions, std::span<const PointValues> values,
          double width, std::span<Resampled> results)
{
    const auto          nodes = std::size_t(window.grid.nodesZ());
    std::vector<double> row(nodes);
    for (std::size_t begin = 0; begin < values.size(); begin += LogMeanSums::kTogether) {
        const std::size_t count = std::min(LogMeanSums::kTogether, values.size() - begin);
        const LogMeanSums sums(window, positions, values.subspan(begin, count), width);
        for (std::size_t v = 0; v < count; ++v)
            for (int i = 0; i < window.grid.nodesX(); ++i) {
                sums.means(i, v, row);
                double* to = &results[begin + v].rigidity.values()[std::size_t(i) * nodes];
                for (std::size_t j = 0; j < nodes; ++j) to[j] = std::isnan(to[j]) ? row[j] : to[j];
            }
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

ChartPoint PatchWindow::nearest(const ChartPoint& p) const noexcept
{
    return {std::clamp(p.x, corner.x, corner.x + grid.sizeX()), std::clamp(p.z, corner.z, corner.z + grid.sizeZ())};
}

double kernelReach(double pointSpacing, double nodeSpacing) noexcept
{
    return kResamplingReach * resamplingWidth(pointSpacing, nodeSpacing);
}

std::vector<Resampled> resampleAll(const PatchWindow& window, std::span<const ChartPoint> positions,
                                   std::span<const PointValues> values, Resampling resampling, double pointSpacing,
                                   double sparsest, Sampling sampling, double exact)
{
    for (const PointValues& of : values)
        PALP_EXPECT(!positions.empty() && positions.size() == of.size(),
                    std::to_string(positions.size()) + " positions, " + std::to_string(of.size()) + " values");
    const PlateGrid& grid = window.grid;
    const double     cell = std::max(grid.spacingX, grid.spacingZ);
    const double     width =
        sampling == Sampling::means ? resamplingWidthOfMeans(pointSpacing, cell) : resamplingWidth(pointSpacing, cell);
    const double widest = resamplingWidth(std::max(pointSpacing, sparsest), cell);

    PALP_EXPECT(areFinite(positions), "a point is not finite");

    std::vector<Resampled> results(values.size(), {NodeField(grid, std::numeric_limits<double>::quiet_NaN()), 0});
    if (resampling == Resampling::logMean) {
        fill(window, positions, values, width, results);
        const auto isFull = [&nodes = results[0].rigidity.values()] {
            return std::ranges::none_of(nodes, [](double value) { return std::isnan(value); });
        };
        for (double wider = 2 * width; wider < 2 * widest && !isFull(); wider *= 2)
            fill(window, positions, values, std::min(wider, widest), results);
        if (isFull() && surelyCovered(window, positions, widest)) return results;
    }
    takeNearest(window, positions, values, kResamplingNearby * widest, exact, results);
    return results;
}

Resampled resampleRigidity(const PatchWindow& window, std::span<const ChartPoint> positions,
                           std::span<const double> rigidities, Resampling resampling, double pointSpacing,
                           double sparsest, Sampling sampling)
{
    return std::move(resampleAll(window, positions, {&rigidities, 1}, resampling, pointSpacing, sparsest, sampling)[0]);
}

} // namespace palp
