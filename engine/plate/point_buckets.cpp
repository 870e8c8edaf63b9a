#include "engine/plate/point_buckets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/core/resampling.h"
#include "engine/plate/rigidity_unit.h"

namespace palp {
namespace {

constexpr double      kFarthest     = 1e9;     ///< squares stay finite, and so do the numbers of buckets [spacings]
constexpr float       kLeastSide    = 0x1p-10; ///< edges of 8000 x 8000 cells are whole numbers below 2^24 [spacings]
constexpr std::size_t kFewestToFill = 4;       ///< buckets that are always allowed: 2 x 2 around node (0, 0)

/// Where buckets lie along one axis.
struct Axis {
    float least = std::numeric_limits<float>::max(); ///< [spacings] of the points, within the bounds
    float most  = std::numeric_limits<float>::lowest();
    float low; ///< bounds: the grid and half its size around it [spacings]
    float high;

    explicit Axis(int cells) : low(-(0.5F * float(cells) + 1)), high(1.5F * float(cells) + 1) {}

    void include(float position) noexcept
    {
        least = std::min(least, std::clamp(position, low, high));
        most  = std::max(most, std::clamp(position, low, high));
    }
    [[nodiscard]] int first(float side) const noexcept { return int(std::floor(least / side)); }
    [[nodiscard]] int buckets(float side) const noexcept { return int(std::floor(most / side)) - first(side) + 1; }
};

/// The smallest power of two that makes no more buckets than points.
float sideFor(const Axis& x, const Axis& z, std::size_t points)
{
    const double most = double(std::max(points, kFewestToFill));
    float        side = kLeastSide;
    while (double(x.buckets(side)) * double(z.buckets(side)) > most) side *= 2;
    return side;
}

void refuseBadPoint(const PlatePoints& points, std::size_t n)
{
    const auto [x, z] = points.positions[n];
    const double D    = points.rigidities[n];
    if (!(std::isfinite(x) && std::isfinite(z)))
        throw Error("plate: expected finite positions, found point " + std::to_string(n) + " at " + std::to_string(x) +
                    ", " + std::to_string(z));
    if (!(D > 0 && std::isfinite(D)))
        throw Error("plate: expected finite rigidities above 0, found " + std::to_string(D) + " N m at point " +
                    std::to_string(n));
}

shared::ScatteredPoint scattered(const PlateGrid& grid, const PlatePoints& points, std::size_t n)
{
    refuseBadPoint(points, n);
    const double x = (points.positions[n].x - points.corner.x) / grid.spacingX;
    const double z = (points.positions[n].z - points.corner.z) / grid.spacingZ;
    if (!(std::abs(x) <= kFarthest && std::abs(z) <= kFarthest))
        throw Error("plate: expected points within " + formatQuantity(kFarthest * grid.spacingX, "m") +
                    " of the window, found point " + std::to_string(n) + " farther away");
    const double D = points.rigidities[n];
    return {float(x), float(z), inRigidityUnits(D, points.unit), float(std::log(D / points.unit)), std::uint32_t(n)};
}

shared::PointLayout layoutOf(const PlateGrid& grid, double pointSpacing, std::size_t points)
{
    const double        larger = std::max(grid.spacingX, grid.spacingZ);
    const double        width  = samplingWidth(pointSpacing, larger);
    shared::PointLayout layout{};
    layout.cellsX  = grid.cellsX;
    layout.cellsZ  = grid.cellsZ;
    layout.points  = std::uint32_t(points);
    layout.scaleX  = float(grid.spacingX / larger);
    layout.scaleZ  = float(grid.spacingZ / larger);
    layout.reachX  = float(kSamplingReach * width / grid.spacingX);
    layout.reachZ  = float(kSamplingReach * width / grid.spacingZ);
    layout.falloff = float(-0.5 * (larger / width) * (larger / width));
    layout.nearby2 = float(std::pow(kSamplingNearby * width / larger, 2));
    return layout;
}

} // namespace

PointBuckets bucketPoints(const PlateGrid& grid, const PlatePoints& points)
{
    PALP_EXPECT(points.positions.size() == points.rigidities.size(),
                std::to_string(points.positions.size()) + " positions, " + std::to_string(points.rigidities.size()) +
                    " rigidities");
    PALP_EXPECT(points.spacing >= 0 && std::isfinite(points.spacing) && points.unit > 0 && std::isfinite(points.unit),
                "points " + std::to_string(points.spacing) + " m apart, unit " + std::to_string(points.unit) + " N m");
    if (points.positions.empty()) throw Error("plate: expected points to take the rigidity from, found none");

    // The points as they come, and the box around them.
    const std::size_t                   count = points.positions.size();
    std::vector<shared::ScatteredPoint> given(count);
    Axis                                x(grid.cellsX), z(grid.cellsZ);
    for (std::size_t n = 0; n < count; ++n) {
        given[n] = scattered(grid, points, n);
        x.include(given[n].x);
        z.include(given[n].z);
    }

    PointBuckets         sorted;
    shared::PointLayout& layout = sorted.layout;
    layout                      = layoutOf(grid, points.spacing, count);
    layout.side                 = sideFor(x, z, count);
    layout.perSide              = 1 / layout.side;
    layout.firstX               = x.first(layout.side);
    layout.firstZ               = z.first(layout.side);
    layout.bucketsX             = x.buckets(layout.side);
    layout.bucketsZ             = z.buckets(layout.side);

    // A counting sort, which keeps the order of points within each bucket.
    const auto bucketOf = [&](const shared::ScatteredPoint& p) {
        const int a = int(std::floor(std::clamp(p.x, x.low, x.high) * layout.perSide)) - layout.firstX;
        const int b = int(std::floor(std::clamp(p.z, z.low, z.high) * layout.perSide)) - layout.firstZ;
        return std::size_t(a) * std::size_t(layout.bucketsZ) + std::size_t(b);
    };
    sorted.starts.assign(std::size_t(layout.bucketsX) * std::size_t(layout.bucketsZ) + 1, 0);
    for (const auto& p : given) ++sorted.starts[bucketOf(p) + 1];
    for (std::size_t b = 1; b < sorted.starts.size(); ++b) sorted.starts[b] += sorted.starts[b - 1];
    std::vector<std::uint32_t> next(sorted.starts.begin(), sorted.starts.end() - 1);
    sorted.points.resize(count);
    for (const auto& p : given) sorted.points[next[bucketOf(p)]++] = p;
    return sorted;
}

} // namespace palp
