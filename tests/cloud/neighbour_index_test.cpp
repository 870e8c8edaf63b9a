#include "engine/cloud/neighbour_index.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cloud/detail/point_block.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

using Points = std::vector<glm::dvec3>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN      = std::numeric_limits<double>::quiet_NaN();

double squaredDistance(const glm::dvec3& a, const glm::dvec3& b)
{
    const glm::dvec3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

std::vector<std::uint32_t> bruteGather(const Points& points, const glm::dvec3& centre, double radius)
{
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (squaredDistance(points[i], centre) <= radius * radius) found.push_back(std::uint32_t(i));
    return found;
}

std::vector<std::uint32_t> bruteNearest(const Points& points, const glm::dvec3& centre, std::size_t k)
{
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return squaredDistance(points[a], centre) < squaredDistance(points[b], centre);
    });
    order.resize(std::min(k, order.size()));
    return order;
}

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> numbers)
{
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

void expectGather(const NeighbourIndex& index, const Points& points, const glm::dvec3& centre, double radius)
{
    EXPECT_EQ(sorted(index.gather(centre, radius)), bruteGather(points, centre, radius))
        << "radius " << radius << " at " << centre.x << ", " << centre.y << ", " << centre.z;

    std::vector<std::uint32_t> rising, inOrder, few;
    index.gatherRanks(centre, radius, rising);
    EXPECT_TRUE(index.gatherRanks(centre, radius, 4 * points.size(), few)) << "blocks count as four points";
    EXPECT_EQ(few, rising);
    EXPECT_TRUE(rising.empty() || !index.gatherRanks(centre, radius, rising.size() - 1, few));
    EXPECT_TRUE(std::is_sorted(rising.begin(), rising.end()));
    index.pointsOf(rising, inOrder);
    std::sort(inOrder.begin(), inOrder.end());
    EXPECT_EQ(inOrder, bruteGather(points, centre, radius)) << "in rising order";
}

void expectNearest(const NeighbourIndex& index, const Points& points, const glm::dvec3& centre, std::size_t k)
{
    const auto                 found = index.nearest(centre, k);
    std::vector<std::uint32_t> order;
    for (const Neighbour& neighbour : found) {
        order.push_back(neighbour.point);
        EXPECT_EQ(neighbour.distance, std::sqrt(squaredDistance(points[neighbour.point], centre)));
    }
    EXPECT_EQ(order, bruteNearest(points, centre, k))
        << k << " nearest at " << centre.x << ", " << centre.y << ", " << centre.z;
}

/// Compares with brute force about points of the cloud, beside them and outside, for radii from none to all points and
/// radii that are exactly the distance to some point.
void expectBruteForceAnswers(const Points& points, double size, int centres = 12)
{
    const NeighbourIndex             index(points);
    std::mt19937_64                  random(3);
    std::uniform_real_distribution<> shift(-1, 1);
    for (int c = 0; c < centres; ++c) {
        const glm::dvec3& point  = points[random() % points.size()];
        const double      reach  = size * (c % 3) * 0.5;
        const glm::dvec3  centre = point + reach * glm::dvec3(shift(random), shift(random), shift(random));
        for (const double share : {0.0, 0.01, 0.1, 0.5, 4.0}) expectGather(index, points, centre, share * size);
        for (int r = 0; r < 3; ++r) {
            const double radius = std::sqrt(squaredDistance(points[random() % points.size()], centre));
            for (const double at : {std::nextafter(radius, 0.0), radius, std::nextafter(radius, kInfinity)})
                expectGather(index, points, centre, at);
        }
        for (const std::size_t k : {1, 7, 33, 500}) expectNearest(index, points, centre, k);
    }
}

Points randomVolume(std::size_t count, double size, std::uint64_t seed)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> along(0, size);
    Points                           points(count);
    for (glm::dvec3& p : points) p = {along(random), along(random), along(random)};
    return points;
}

Points randomSphere(std::size_t count, double radius, std::uint64_t seed)
{
    std::mt19937_64            random(seed);
    std::normal_distribution<> normal;
    Points                     points(count);
    for (glm::dvec3& p : points)
        p = radius * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    return points;
}

Points lattice(int edge, double spacing)
{
    Points points;
    for (int i = 0; i < edge; ++i)
        for (int j = 0; j < edge; ++j)
            for (int l = 0; l < edge; ++l) points.push_back(spacing * glm::dvec3(i, j, l));
    return points;
}

TEST(NeighbourIndex, AnswersAreThoseOfBruteForceInARandomVolume)
{
    expectBruteForceAnswers(randomVolume(5000, 0.2, 1), 0.2);
}

TEST(NeighbourIndex, AnswersAreThoseOfBruteForceOnASurface)
{
    expectBruteForceAnswers(randomSphere(20000, 0.1, 2), 0.2);
}

TEST(NeighbourIndex, AnswersAreThoseOfBruteForceOnALatticeWithManyPointsExactlyOnTheRadius)
{
    const double         spacing = 0.125; // a power of two, so that equal distances are equal in doubles too
    const Points         points  = lattice(15, spacing);
    const NeighbourIndex index(points);
    for (const glm::dvec3 node : {glm::dvec3(7, 7, 7), glm::dvec3(0, 3, 14), glm::dvec3(6.5, 6.5, 6.5)}) {
        for (const double radius2 : {0.0, 0.25, 0.75, 1.0, 2.0, 3.0, 9.0, 25.0, 50.0})
            expectGather(index, points, spacing * node, spacing * std::sqrt(radius2));
        for (const std::size_t k : {1, 2, 6, 7, 8, 26, 27, 28, 100, 1000})
            expectNearest(index, points, spacing * node, k);
    }
}

TEST(NeighbourIndex, RadiusBetweenTwoNeighbouringDoublesSplitsThePointsAsBruteForceDoes)
{
    // All points are one to 40 times 2^-52 beyond 1 m from the centre: no float can tell them apart.
    Points points;
    for (int i = 0; i < 40; ++i) points.emplace_back(1 + i * 0x1p-52, 0, 0);
    const NeighbourIndex index(points);
    for (int i = 0; i < 40; ++i) expectGather(index, points, {0, 0, 0}, 1 + i * 0x1p-52);
    expectNearest(index, points, {0, 0, 0}, 17);
    expectNearest(index, points, {2, 0, 0}, 17);
}

TEST(NeighbourIndex, TinyCloudsOfOneToFortyPointsAnswerAsBruteForce)
{
    for (std::size_t count = 1; count <= 40; ++count) {
        SCOPED_TRACE(count);
        expectBruteForceAnswers(randomVolume(count, 1.0, count), 1.0, 2);
    }
}

TEST(NeighbourIndex, CloudsFarFromTheOriginKeepTheirMillimetres)
{
    Points points = randomSphere(20000, 0.1, 5); // about 2.5 mm apart
    for (glm::dvec3& p : points) p += glm::dvec3(500000, 5400000, 300);
    expectBruteForceAnswers(points, 0.2);
}

TEST(NeighbourIndex, StrayPointsFarAwayLeaveTheAnswersExact)
{
    Points points = randomSphere(5000, 0.1, 6);
    for (glm::dvec3& p : points) p += glm::dvec3(500000, 5400000, 300);
    points.emplace_back(0, 0, 0);
    expectBruteForceAnswers(points, 0.2, 6);
    points.emplace_back(1e12, 0, 0);
    expectBruteForceAnswers(points, 0.2, 6);
    expectBruteForceAnswers(points, 1e12, 6);
}

/// A second object off in all three axes is ordered along the curve too: searches there took its square.
TEST(NeighbourIndex, AnObjectThatLiesOffIsOrderedLikeTheFirst)
{
    Points points = randomSphere(20'000, 0.05, 7), off = randomSphere(1500, 0.05, 8);
    for (const glm::dvec3& p : off) points.push_back(p + glm::dvec3(0.3));
    std::shuffle(points.begin(), points.end(), std::mt19937_64(9));
    const NeighbourIndex      index(points);
    double                    way = 0; // of one of its points to the next [m]
    std::optional<glm::dvec3> last;
    for (const std::uint32_t point : index.pointsByRank()) {
        if (points[point].x < 0.2) continue;
        if (last) way += glm::distance(points[point], *last) / double(off.size());
        last = points[point];
    }
    EXPECT_LT(way, 0.02) << "0.067 in a random order, some 5 mm between neighbours";
    expectBruteForceAnswers(points, 0.02, 6);
}

TEST(NeighbourIndex, ClumpsTooFineForFloatsAreResolved)
{
    // The median of the cloud lies in one of two clumps, so that floats cannot resolve the other; and in the finest,
    // squares of floats underflow.
    for (const double clump : {1e-5, 1e-7, 1e-12, 1e-25}) {
        Points points = randomVolume(1000, clump, 22);
        for (const glm::dvec3& p : randomVolume(900, clump, 23))
            points.push_back(p + glm::dvec3(clump > 1e-15 ? 1 : 0));
        for (const glm::dvec3& p : randomVolume(500, 1.0, 24)) points.push_back(p);
        const NeighbourIndex index(points);
        for (std::size_t i = 0; i < 1900; i += 190) {
            for (const double share : {0.01, 0.1, 0.3, 0.6, 1.0, 2.0})
                expectGather(index, points, points[i], share * clump);
            for (const std::size_t k : {1, 7, 40, 890, 1100}) expectNearest(index, points, points[i], k);
        }
    }
}

/// Points in spirals: of each sixty, each is half as far from the origin as the one before.
Points shrinkingRings(std::size_t count)
{
    Points points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back(std::ldexp(1.0, -int(i % 60)) * glm::dvec3(std::cos(double(i)), std::sin(double(i)), 0));
    return points;
}

TEST(NeighbourIndex, ClumpsWithinClumpsAnswerAsBruteForce)
{
    Points points = shrinkingRings(3000);
    for (const double size : {1.0, 1e-3, 1e-7, 1e-12, 1e-16}) expectBruteForceAnswers(points, size);

    // A clump that is a part of another, a place with very many points, and one far off with another clump of strays.
    points = randomVolume(1000, 1.0, 26);
    for (const glm::dvec3& p : randomVolume(1000, 1e-8, 27)) points.push_back(0.4 + p);
    for (const glm::dvec3& p : randomVolume(1000, 1e-15, 28)) points.push_back(0.4 + 3e-9 + p);
    points.resize(points.size() + 500, glm::dvec3(0.4 + 1e-9));
    for (const glm::dvec3& p : randomVolume(300, 1e-5, 29)) points.push_back(glm::dvec3(500, -300, 0) + p);
    for (const double size : {1.0, 1e-8, 1e-15}) {
        expectBruteForceAnswers(points, size);
        const NeighbourIndex index(points);
        for (const glm::dvec3& centre : {points[1500], points[2500], points[3100], points[3600]})
            for (const double share : {0.1, 0.5, 2.0}) {
                expectGather(index, points, centre, share * size);
                expectGather(index, points, centre + share * size, size);
                for (const std::size_t k : {1, 7, 400, 1200}) expectNearest(index, points, centre + share * size, k);
            }
    }
}

TEST(NeighbourIndex, ABallInAClumpIsNotSearchedThroughAllOfIt)
{
    Points points = randomVolume(10'000, 1e-6, 30);
    for (const glm::dvec3& p : randomVolume(10'000, 1e-6, 31)) points.push_back(p + glm::dvec3(1, 0, 0));
    const NeighbourIndex       index(points);
    std::vector<std::uint32_t> near;
    for (std::size_t i = 0; i < points.size(); i += 500)
        EXPECT_TRUE(index.gatherRanks(points[i], 3 * index.spacing(), 400, near))
            << "it holds " << near.size() << " of the points that have been looked at, 60 on average";
}

TEST(NeighbourIndex, CloudsOfExtremeSizesAnswerAsBruteForce)
{
    for (const double size : {1e-170, 1e-120, 1e-30, 1e-9, 1e6, 1e30, 1e140, 1e150, 1e156, 1e160, 1e307}) {
        SCOPED_TRACE(size);
        expectBruteForceAnswers(randomVolume(500, size, 7), size, 6);
    }
}

TEST(NeighbourIndex, EqualPointsAreAllFoundAndComeByRisingIndex)
{
    Points points(1000, glm::dvec3(0.3, -0.2, 0.1));
    expectBruteForceAnswers(points, 1.0, 3);
    points.resize(1500, glm::dvec3(0.3, -0.2, 0.2));
    expectBruteForceAnswers(points, 0.2);
}

TEST(NeighbourIndex, FarCentresAndHugeRadiiAnswerAsBruteForce)
{
    const Points         points = randomVolume(300, 1.0, 8);
    const NeighbourIndex index(points);
    for (const double far : {10.0, 1e5, 1e7, 1e12, 1e30, 1e200}) {
        const glm::dvec3 centre(far, -far, 0.5);
        for (const double radius : {0.5, far, 1.5 * far, 1e300, kInfinity}) expectGather(index, points, centre, radius);
        const double radius = std::sqrt(squaredDistance(points[17], centre));
        expectGather(index, points, centre, radius);
        expectNearest(index, points, centre, 20);
    }
    EXPECT_EQ(index.gather({0.5, 0.5, 0.5}, kInfinity).size(), points.size());
}

TEST(NeighbourIndex, NearestGivesNothingForNoneAndEverythingForMoreThanThereAre)
{
    const Points         points = randomVolume(100, 1.0, 9);
    const NeighbourIndex index(points);

    EXPECT_TRUE(index.nearest({0, 0, 0}, 0).empty());
    expectNearest(index, points, {0.2, 0.3, 0.4}, 100);
    expectNearest(index, points, {0.2, 0.3, 0.4}, 101);
    EXPECT_EQ(index.nearest({0, 0, 0}, std::numeric_limits<std::size_t>::max()).size(), 100U);
}

TEST(NeighbourIndex, NearestFindsAcrossAGapInDensity)
{
    // The usual distance says nothing about the sparse half, nor about the dense clump.
    Points points = randomVolume(3000, 0.01, 10);
    for (const glm::dvec3& p : randomVolume(300, 10.0, 11)) points.push_back(p);
    const NeighbourIndex index(points);
    for (const glm::dvec3 centre : {glm::dvec3(0.005), glm::dvec3(5.0), glm::dvec3(-3, 4, 20)})
        for (const std::size_t k : {1, 6, 40, 290, 3200}) expectNearest(index, points, centre, k);
}

TEST(NeighbourIndex, GatherReplacesWhatTheVectorHeld)
{
    const NeighbourIndex       index(randomVolume(100, 1.0, 12));
    std::vector<std::uint32_t> found(7, 12345);

    index.gather({50, 50, 50}, 1.0, found);

    EXPECT_TRUE(found.empty());
}

TEST(NeighbourIndex, OrderOfTheFoundPointsIsThatOfEveryOtherIndexOverTheCloud)
{
    // Enough blocks that Embree builds with several threads, whose timing must not show.
    const Points         points = randomSphere(300000, 0.1, 13);
    const NeighbourIndex first(points), second(points);
    for (std::size_t i = 0; i < points.size(); i += 9001)
        EXPECT_EQ(first.gather(points[i], 0.01), second.gather(points[i], 0.01));
}

TEST(NeighbourIndex, SeveralThreadsGetTheAnswersOfOne)
{
    const Points         points = randomSphere(20000, 0.1, 14);
    const NeighbourIndex index(points);
    std::atomic<int>     mistakes = 0;
    const auto           hand     = [&](std::size_t from) {
        std::vector<std::uint32_t> found;
        for (std::size_t i = from; i < points.size(); i += 101) {
            index.gather(points[i], 0.01, found);
            if (sorted(found) != bruteGather(points, points[i], 0.01)) ++mistakes;
            if (index.nearest(points[i], 1).front().distance != 0) ++mistakes;
        }
    };
    std::vector<std::thread> hands;
    for (std::size_t t = 0; t < 4; ++t) hands.emplace_back(hand, t);
    for (std::thread& thread : hands) thread.join();

    EXPECT_EQ(mistakes, 0);
}

TEST(NeighbourIndex, GatherIntoEnoughCapacityKeepsTheMemory)
{
    const Points               points = randomSphere(20000, 0.1, 15);
    const NeighbourIndex       index(points);
    std::vector<std::uint32_t> found;
    index.gather(points[0], 0.02, found);
    std::vector<std::uint32_t> exactlyEnough(found);
    const auto*                memory = exactlyEnough.data();

    index.gather(points[0], 0.02, exactlyEnough);

    EXPECT_GT(exactlyEnough.size(), 100U);
    EXPECT_EQ(exactlyEnough.data(), memory);
}

TEST(NeighbourIndex, MovedIndexStillAnswers)
{
    const Points   points = randomVolume(200, 1.0, 16);
    NeighbourIndex first(points);
    NeighbourIndex index(std::move(first));

    EXPECT_EQ(index.size(), 200U);
    expectGather(index, points, points[3], 0.4);
}

TEST(NeighbourIndex, SpacingOfASquareLatticeIsItsSixthNeighbourDistanceTimesTheDocumentedFactor)
{
    Points points;
    for (int i = 0; i < 200; ++i)
        for (int j = 0; j < 200; ++j) points.emplace_back(0.001 * i, 0.001 * j, 0);

    // Four neighbours at 1, four at sqrt(2); the distance is that of the rounded positions.
    EXPECT_NEAR(NeighbourIndex(points).spacing(), 0.001 * std::sqrt(2.0) * std::sqrt(std::numbers::pi / 6), 1e-12);
}

TEST(NeighbourIndex, SpacingOfARandomSheetIsOneOverTheRootOfItsDensity)
{
    Points points = randomVolume(40000, 1.0, 17);
    for (glm::dvec3& p : points) p.z = 0;

    // 2000 samples of a Gamma(6) distribution: its median is 5.67 instead of 6, so 0.972; scatter of the median 0.6 %.
    EXPECT_NEAR(NeighbourIndex(points).spacing() * 200, 0.972, 0.02);
}

TEST(NeighbourIndex, SpacingIsZeroIfThereAreFewPointsOrMostCoincide)
{
    EXPECT_EQ(NeighbourIndex(randomVolume(6, 1.0, 18)).spacing(), 0.0);
    EXPECT_GT(NeighbourIndex(randomVolume(7, 1.0, 18)).spacing(), 0.0);

    Points points = randomVolume(400, 1.0, 19);
    points.resize(1000, glm::dvec3(0.5));
    EXPECT_EQ(NeighbourIndex(points).spacing(), 0.0);
}

TEST(NeighbourIndex, BrokenPreconditionsAreRefused)
{
    EXPECT_THROW(NeighbourIndex(Points{}), ContractViolation);
    EXPECT_THROW(NeighbourIndex(Points{{0, 0, 0}, {0, kNaN, 0}}), ContractViolation);
    EXPECT_THROW(NeighbourIndex(Points{{kInfinity, 0, 0}}), ContractViolation);

    const NeighbourIndex index(randomVolume(10, 1.0, 20));
    EXPECT_THROW((void)index.gather({0, 0, 0}, -1e-9), ContractViolation);
    EXPECT_THROW((void)index.gather({0, 0, 0}, kNaN), ContractViolation);
    EXPECT_THROW((void)index.gather({0, kInfinity, 0}, 1), ContractViolation);
    EXPECT_THROW((void)index.nearest({kNaN, 0, 0}, 1), ContractViolation);
}

TEST(BlockFilter, EveryFilterOfThisProcessorSplitsABlockAtBothRadii)
{
    std::mt19937                          random(21);
    std::uniform_real_distribution<float> along(-1, 1);
    for (int round = 0; round < 200; ++round) {
        PointBlock block;
        for (int i = 0; i < kBlockPoints; ++i) {
            block.x[i]     = along(random);
            block.y[i]     = along(random);
            block.z[i]     = along(random);
            block.point[i] = 1000 + std::uint32_t(i);
        }
        const Shell shell{along(random), along(random), along(random), round % 5 == 0 ? -1.0F : 0.7F, 1.3F};
        std::vector<std::uint32_t> certain;
        std::uint32_t              doubtful = 0;
        for (int i = 0; i < kBlockPoints; ++i) {
            const double d2 = squaredDistance({block.x[i], block.y[i], block.z[i]}, {shell.x, shell.y, shell.z});
            if (d2 <= double(shell.inner2))
                certain.push_back(block.point[i]);
            else if (d2 <= double(shell.outer2))
                doubtful |= std::uint32_t(1) << i;
        }
        for (const BlockFilter& filter : blockFilters()) {
            std::vector<std::uint32_t> found(kBlockPoints);
            std::uint32_t              maybe = 0;
            found.resize(filter.gather(block, shell, found.data(), maybe));
            float               distance2[kBlockPoints];
            const std::uint32_t near = filter.measure(block, shell, distance2);

            EXPECT_EQ(found, certain);
            EXPECT_EQ(maybe, doubtful);
            EXPECT_EQ(std::size_t(std::popcount(near)), certain.size() + std::size_t(std::popcount(doubtful)));
            for (int i = 0; i < kBlockPoints; ++i) { // 2^-21: the rounding that the index allows for
                const double d2 = squaredDistance({block.x[i], block.y[i], block.z[i]}, {shell.x, shell.y, shell.z});
                EXPECT_NEAR(double(distance2[i]), d2, 0x1p-21 * (d2 + 1));
            }
        }
    }
}

} // namespace
} // namespace palp
