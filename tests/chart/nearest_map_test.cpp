#include "engine/chart/nearest_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

using Points = std::vector<ChartPoint>;

std::vector<std::uint32_t> bruteForce(const PlateGrid& grid, const ChartPoint& origin, const Points& points)
{
    std::vector<std::uint32_t> nearest;
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) {
            double        best  = std::numeric_limits<double>::infinity();
            std::uint32_t which = 0;
            for (std::size_t p = 0; p < points.size(); ++p) {
                const double dx = origin.x + i * grid.spacingX - points[p].x;
                const double dz = origin.z + j * grid.spacingZ - points[p].z;
                const double d2 = dx * dx + dz * dz;
                if (d2 < best) {
                    best  = d2;
                    which = std::uint32_t(p);
                }
            }
            nearest.push_back(which);
        }
    return nearest;
}

/// Points all over the grid and, by `beyond` of its size, around it.
Points scattered(const PlateGrid& grid, const ChartPoint& origin, double perCell, double beyond, unsigned seed)
{
    std::mt19937                     random(seed);
    std::uniform_real_distribution<> along(-beyond, 1 + beyond);
    const double                     area = (1 + 2 * beyond) * (1 + 2 * beyond) * grid.cellsX * grid.cellsZ;
    Points                           points(std::size_t(std::max(1.0, perCell * area)));
    for (ChartPoint& p : points) p = {origin.x + along(random) * grid.sizeX(), origin.z + along(random) * grid.sizeZ()};
    return points;
}

const PlateGrid  kGrid{37, 29, 0.0005, 0.0007};
const ChartPoint kOrigin{-0.0091, 0.0123};

TEST(NearestMap, AnswersAreThoseOfBruteForceAtEveryDensity)
{
    for (const double perCell : {0.01, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0, 100.0})
        for (const double beyond : {0.0, 0.2, 2.0}) {
            const Points points = scattered(kGrid, kOrigin, perCell / (1 + beyond), beyond, unsigned(1000 * perCell));
            EXPECT_EQ(nearestPoint(kGrid, kOrigin, points), bruteForce(kGrid, kOrigin, points))
                << perCell << " points per cell, " << beyond << " beyond";
        }
}

TEST(NearestMap, ClusteredPointsLeaveTheirHolesToTheNearestOfThem)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937                     random(seed);
        std::uniform_real_distribution<> along(-0.3, 1.3);
        std::normal_distribution<>       around(0, 0.001 * (seed + 1));
        Points                           points;
        for (int cluster = 0; cluster < 3; ++cluster) {
            const ChartPoint centre{kOrigin.x + along(random) * kGrid.sizeX(),
                                    kOrigin.z + along(random) * kGrid.sizeZ()};
            for (int p = 0; p < 500; ++p) points.push_back({centre.x + around(random), centre.z + around(random)});
        }
        EXPECT_EQ(nearestPoint(kGrid, kOrigin, points), bruteForce(kGrid, kOrigin, points)) << "seed " << seed;
    }
}

/// Far from all points the answer is one of the neighbours': by at most a cell's diagonal it is farther than the
/// nearest.
TEST(NearestMap, BeyondWhatIsWantedExactlyAPointIsNear)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937               random(seed);
        std::normal_distribution<> around(0, 0.0015);
        Points                     points;
        for (int p = 0; p < 300; ++p)
            points.push_back(
                {kOrigin.x + 0.3 * kGrid.sizeX() + around(random), kOrigin.z + 0.6 * kGrid.sizeZ() + around(random)});
        const double exact = 0.002;
        const auto   found = nearestPoint(kGrid, kOrigin, points, exact), truth = bruteForce(kGrid, kOrigin, points);
        for (std::size_t n = 0; n < found.size(); ++n) {
            const double x  = kOrigin.x + double(n / 30) * kGrid.spacingX,
                         z  = kOrigin.z + double(n % 30) * kGrid.spacingZ;
            const auto away = [&](std::uint32_t p) { return std::hypot(points[p].x - x, points[p].z - z); };
            if (away(truth[n]) <= exact)
                EXPECT_EQ(found[n], truth[n]) << n;
            else
                EXPECT_LE(away(found[n]), away(truth[n]) + 0.00086) << n;
        }
    }
    const Points far{{1, 1}, {-1, 3}};
    EXPECT_EQ(nearestPoint(kGrid, kOrigin, far, 0.001), bruteForce(kGrid, kOrigin, far));
}

TEST(NearestMap, OnePointIsNearestToAllNodesWhereverItIs)
{
    for (const ChartPoint p : {ChartPoint{0, 0.02}, ChartPoint{-1e6, 3}, ChartPoint{1e200, -1e200}})
        EXPECT_EQ(nearestPoint(kGrid, kOrigin, Points{p}), std::vector<std::uint32_t>(kGrid.nodes(), 0));
}

TEST(NearestMap, EquallyNearPointsGiveTheLowestNumber)
{
    // Binary fractions, so that distances that are equal are equal in doubles: points on nodes, on middles of edges and
    // of cells, each twice, in random order.
    const PlateGrid  grid{20, 17, 0.25, 0.25};
    const ChartPoint origin{-2, 1};
    for (const double step : {0.125, 0.25, 0.5, 1.0, 2.0})
        for (const double shift : {0.0, 0.125}) {
            Points points;
            for (double x = -3; x < 4; x += step)
                for (double z = 0; z < 6; z += step) points.insert(points.end(), 2, {x + shift, z + shift});
            std::shuffle(points.begin(), points.end(), std::mt19937(5));
            EXPECT_EQ(nearestPoint(grid, origin, points), bruteForce(grid, origin, points))
                << "step " << step << ", shift " << shift;
        }
    EXPECT_EQ(nearestPoint(grid, origin, Points(100, {0.1, 0.1})), std::vector<std::uint32_t>(grid.nodes(), 0));
}

TEST(NearestMap, PointsOnALineAnswerAsBruteForce)
{
    Points along, across;
    for (int p = 0; p < 3000; ++p) {
        along.push_back({kOrigin.x + p * 1e-5, kOrigin.z + 0.003});
        across.push_back({kOrigin.x - 0.001, kOrigin.z + p * 1e-5});
    }
    EXPECT_EQ(nearestPoint(kGrid, kOrigin, along), bruteForce(kGrid, kOrigin, along));
    EXPECT_EQ(nearestPoint(kGrid, kOrigin, across), bruteForce(kGrid, kOrigin, across));
}

TEST(NearestMap, GridsOfEveryShapeAnswerAsBruteForce)
{
    for (const PlateGrid grid : {PlateGrid{1, 1, 0.1, 0.1}, PlateGrid{2, 90, 0.1, 0.02}, PlateGrid{70, 1, 0.001, 0.3},
                                 PlateGrid{0, 0, 1, 1}, PlateGrid{0, 5, 1, 1}, PlateGrid{16, 16, 10, 0.001}})
        for (const double perCell : {0.3, 3.0}) {
            const Points points =
                scattered(PlateGrid{std::max(grid.cellsX, 1), std::max(grid.cellsZ, 1), grid.spacingX, grid.spacingZ},
                          kOrigin, perCell, 0.5, 7);
            EXPECT_EQ(nearestPoint(grid, kOrigin, points), bruteForce(grid, kOrigin, points))
                << grid.cellsX << " x " << grid.cellsZ;
        }
}

TEST(NearestMap, GridsFarFromTheOriginAnswerAsBruteForce)
{
    const PlateGrid  grid{30, 30, 0.001, 0.001};
    const ChartPoint origin{500000, -5400000}; // doubles are 1e-9 m apart here, a millionth of a step
    const Points     points = scattered(grid, origin, 1.0, 0.3, 8);
    EXPECT_EQ(nearestPoint(grid, origin, points), bruteForce(grid, origin, points));

    const ChartPoint farther{1e12, 1e12}; // and here 1e-4 m, a tenth of a step
    const Points     coarse = scattered(grid, farther, 1.0, 0.3, 9);
    EXPECT_EQ(nearestPoint(grid, farther, coarse), bruteForce(grid, farther, coarse));
}

TEST(NearestMap, BrokenPreconditionsAreRefused)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)nearestPoint(kGrid, kOrigin, {}), ContractViolation);
    EXPECT_THROW((void)nearestPoint(kGrid, kOrigin, Points{{0, nan}}), ContractViolation);
    EXPECT_THROW((void)nearestPoint(PlateGrid{3, 3, 0, 1}, kOrigin, Points{{0, 0}}), ContractViolation);
}

} // namespace
} // namespace palp
