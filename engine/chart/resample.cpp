#include "engine/chart/resample.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/chart/nearest_map.h"

namespace palp {
namespace {

/// Range of node numbers within `reach` of `position` along one axis.
struct NodeRange {
    int first = 0;
    int last  = -1;

    NodeRange(double position, double reach, double spacing, int nodes)
        : first(int(std::max(0.0, std::ceil((position - reach) / spacing)))),
          last(int(std::min(nodes - 1.0, std::floor((position + reach) / spacing))))
    {
    }
};

/// Gaussian-weighted mean of ln D; where no point reaches, the sum of the weights stays 0.
struct LogMean {
    NodeField weight;    ///< sum of w [1]
    NodeField logarithm; ///< sum of w ln(D / 1 N m) [1]
};

/// Spreads every point over the nodes around it. The weight is a product of one factor a side, so that the
/// exponentials are computed per row and column rather than per node.
LogMean spread(const Window& window, std::span<const ChartPoint> positions, std::span<const double> rigidities,
               double width)
{
    const PlateGrid&    grid = window.grid;
    LogMean             sums{NodeField(grid), NodeField(grid)};
    std::vector<double> factorZ;
    const auto          factor = [&](double distance) { return std::exp(-distance * distance / (2 * width * width)); };
    for (std::size_t n = 0; n < positions.size(); ++n) {
        const double    x = positions[n].x - window.corner.x, z = positions[n].z - window.corner.z;
        const double    reach = kSamplingReach * width, logarithm = std::log(rigidities[n]);
        const NodeRange rows(x, reach, grid.spacingX, grid.nodesX()), columns(z, reach, grid.spacingZ, grid.nodesZ());
        factorZ.clear();
        for (int j = columns.first; j <= columns.last; ++j) factorZ.push_back(factor(z - j * grid.spacingZ));
        for (int i = rows.first; i <= rows.last; ++i) {
            const double factorX = factor(x - i * grid.spacingX);
            for (int j = columns.first; j <= columns.last; ++j) {
                const double weight = factorX * factorZ[std::size_t(j - columns.first)];
                sums.weight(i, j) += weight;
                sums.logarithm(i, j) += weight * logarithm;
            }
        }
    }
    return sums;
}

} // namespace

const char* name(Sampling sampling) noexcept
{
    return sampling == Sampling::logMean ? "log-mean" : "nearest";
}

std::optional<Sampling> samplingNamed(std::string_view text)
{
    for (Sampling sampling : {Sampling::logMean, Sampling::nearest})
        if (name(sampling) == text) return sampling;
    return {};
}

Window Window::square(double size, int cells)
{
    PALP_EXPECT(size > 0 && std::isfinite(size), "window size " + std::to_string(size) + " m");
    PALP_EXPECT(cells >= 2 && cells % 2 == 0, std::to_string(cells) + " cells; the contact must be a node");
    return {{cells, cells, size / cells, size / cells}, {-size / 2, -size / 2}};
}

bool Window::holds(const ChartPoint& p) const noexcept
{
    return p.x >= corner.x && p.x <= corner.x + grid.sizeX() && p.z >= corner.z && p.z <= corner.z + grid.sizeZ();
}

double kernelReach(double pointSpacing, double nodeSpacing) noexcept
{
    return kSamplingReach * samplingWidth(pointSpacing, nodeSpacing);
}

Resampled resampleRigidity(const Window& window, std::span<const ChartPoint> positions,
                           std::span<const double> rigidities, Sampling sampling, double pointSpacing)
{
    PALP_EXPECT(!positions.empty() && positions.size() == rigidities.size(),
                std::to_string(positions.size()) + " positions, " + std::to_string(rigidities.size()) + " rigidities");
    const PlateGrid& grid  = window.grid;
    const double     width = samplingWidth(pointSpacing, std::max(grid.spacingX, grid.spacingZ));

    const std::vector<std::uint32_t> nearest = nearestPoint(grid, window.corner, positions);
    const LogMean sums = sampling == Sampling::logMean ? spread(window, positions, rigidities, width) : LogMean{};

    Resampled result{NodeField(grid), 0};
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) {
            const std::uint32_t point = nearest[std::size_t(i) * std::size_t(grid.nodesZ()) + std::size_t(j)];
            const double        away  = std::hypot(positions[point].x - window.corner.x - i * grid.spacingX,
                                                   positions[point].z - window.corner.z - j * grid.spacingZ);
            result.nodesWithoutPoint += away > kSamplingNearby * width;
            const bool averaged   = sampling == Sampling::logMean && sums.weight(i, j) > 0;
            result.rigidity(i, j) = averaged ? std::exp(sums.logarithm(i, j) / sums.weight(i, j)) : rigidities[point];
        }
    return result;
}

} // namespace palp
