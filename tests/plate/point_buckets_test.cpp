#include "engine/plate/point_buckets.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

// How bad points are refused is tested with engine/plate/scattered_points.h, what kernels make of buckets in
// tests/plate/kernels.

namespace palp {
namespace {

constexpr PlateGrid  kGrid{32, 24, 0.5, 0.25};
constexpr ChartPoint kCorner{-3, 2};

/// Points at random between two places, in spacings of the grid.
PointBuckets bucketsOf(std::size_t points, ChartPoint from, ChartPoint to)
{
    std::mt19937            bits{7};
    const auto              uniform = [&](double low, double high) { return low + (high - low) * (bits() / 0x1p32); };
    std::vector<ChartPoint> positions(points);
    for (ChartPoint& p : positions)
        p = {kCorner.x + 0.5 * uniform(from.x, to.x), kCorner.z + 0.25 * uniform(from.z, to.z)};
    const std::vector<double> rigidities(points, 1.0);
    return bucketPoints(kGrid, {positions, rigidities, kCorner, 0.1, 1});
}

/// Over, beside, around and far from the grid.
std::vector<PointBuckets> manyBuckets()
{
    return {bucketsOf(1000, {-5, -5}, {40, 30}),   bucketsOf(700, {5, 5}, {5.5, 20}),  bucketsOf(1, {3, 4}, {3, 4}),
            bucketsOf(3, {-9, -9}, {40, 40}),      bucketsOf(500, {70, -80}, {90, 3}), bucketsOf(400, {7, 7}, {7, 7}),
            bucketsOf(900, {-300, -200}, {99, 99})};
}

TEST(PointBuckets, EveryPointIsInOneBucketBetweenItsEdgesInItsOrder)
{
    for (const PointBuckets& sorted : manyBuckets()) {
        const shared::PointLayout& g = sorted.layout;
        std::vector<int>           seen(sorted.points.size(), 0);
        ASSERT_EQ(sorted.starts.size(), std::size_t(g.bucketsX * g.bucketsZ) + 1);
        EXPECT_EQ(sorted.starts.front(), 0U);
        EXPECT_EQ(sorted.starts.back(), sorted.points.size());
        const auto within = [&](float position, int bucket, int first, int buckets) {
            return (position >= float(first + bucket) * g.side || bucket == 0) &&
                   (position < float(first + bucket + 1) * g.side || bucket + 1 == buckets);
        };
        for (int a = 0; a < g.bucketsX; ++a)
            for (int b = 0; b < g.bucketsZ; ++b) {
                const auto bucket = std::size_t(a * g.bucketsZ + b);
                ASSERT_LE(sorted.starts[bucket], sorted.starts[bucket + 1]);
                for (std::size_t n = sorted.starts[bucket]; n < sorted.starts[bucket + 1]; ++n) {
                    const shared::ScatteredPoint& p = sorted.points[n];
                    EXPECT_TRUE(within(p.x, a, g.firstX, g.bucketsX) && within(p.z, b, g.firstZ, g.bucketsZ));
                    ++seen[p.number];
                    if (n > sorted.starts[bucket]) {
                        EXPECT_LT(sorted.points[n - 1].number, p.number);
                    }
                }
            }
        EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
    }
}

TEST(PointBuckets, ASideIsAPowerOfTwoThatMakesNoMoreBucketsThanPoints)
{
    for (const PointBuckets& sorted : manyBuckets()) {
        const shared::PointLayout& g = sorted.layout;
        int                        exponent;
        EXPECT_EQ(std::frexp(g.side, &exponent), 0.5F);
        EXPECT_EQ(g.side * g.perSide, 1.0F);
        EXPECT_LE(std::size_t(g.bucketsX) * std::size_t(g.bucketsZ), std::max<std::size_t>(sorted.points.size(), 4));
        // not whole sides beyond the grid and half its size around it, however far the points lie
        EXPECT_GT(float(g.firstX + 1) * g.side, -17.0F);
        EXPECT_LE(float(g.firstX + g.bucketsX - 1) * g.side, 49.0F);
    }
    const shared::PointLayout even = bucketsOf(1000, {0, 0}, {32, 24}).layout;
    EXPECT_GT(4.5 * even.bucketsX * even.bucketsZ, 1000) << "about one to four points per bucket";
}

/// Points that all nodes together look at.
struct Counting {
    using uint        = shared::uint;
    using PointLayout = shared::PointLayout;
    const PointBuckets& sorted;
    mutable int         looks = 0;

    static float max(float a, float b) { return std::max(a, b); }
    static float min(float a, float b) { return std::min(a, b); }
    static float floor(float a) { return std::floor(a); }
    int          bucketStart(int n) const { return int(sorted.starts[std::size_t(n)]); }
    float        pointX(int n) const { return ++looks, sorted.points[std::size_t(n)].x; }
    float        pointZ(int n) const { return sorted.points[std::size_t(n)].z; }
    uint         pointNumber(int n) const { return sorted.points[std::size_t(n)].number; }

#include "compute_shaders/shared/nearest_point.h"
};

TEST(PointBuckets, ANodeLooksAtFewPointsWhereverTheyLie)
{
    const auto looksPerNode = [](const PointBuckets& sorted) {
        Counting count{sorted};
        for (int i = 0; i <= kGrid.cellsX; ++i)
            for (int j = 0; j <= kGrid.cellsZ; ++j) (void)count.nearestPoint(sorted.layout, i, j);
        return double(count.looks) / double(kGrid.nodes());
    };
    EXPECT_LT(looksPerNode(bucketsOf(1000, {-5, -5}, {40, 30})), 24) << "all over the grid";
    EXPECT_LT(looksPerNode(bucketsOf(1000, {31, 23}, {32, 24})), 24) << "in a corner";
    EXPECT_LT(looksPerNode(bucketsOf(1000, {40, -9}, {45, 30})), 24) << "beside it";
}

} // namespace
} // namespace palp
