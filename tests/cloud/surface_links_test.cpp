#include "engine/cloud/surface_links.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/cloud/samples.h"
#include "engine/cloud/soft_object.h"
#include "engine/cloud/surface_flood.h"

namespace palp {
namespace {

using Points = std::vector<glm::dvec3>; ///< [m]

constexpr double kSpacing = 0.5e-3; ///< of the bodies [m]

/// Returns a random sheet.
/// \param from, to  along x [m]
Points sheet(std::uint64_t seed, double z, double spacing = kSpacing, double from = -20e-3, double to = 20e-3)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> along(from, to), across(-20e-3, 20e-3);
    Points                           points;
    for (int n = 0; n < int((to - from) * 40e-3 / (spacing * spacing)); ++n) {
        const double x = along(random);
        points.emplace_back(x, across(random), z);
    }
    return points;
}

Points together(Points a, const Points& b)
{
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Points noisy(Points points, double noise)
{
    std::mt19937_64            random(3);
    std::normal_distribution<> normal(0, noise);
    for (glm::dvec3& p : points) p += glm::dvec3(normal(random), normal(random), normal(random));
    return points;
}

/// A rod, which is no surface.
Points rod()
{
    Points points;
    for (int n = 0; n < 400; ++n) points.emplace_back(n * 1e-4 - 20e-3, 0, 0.4e-3);
    return points;
}

Points cloudOf(const char* sample)
{
    const PointCloud cloud = makeSample(sampleNamed(sample), 20'000, 1);
    return {cloud.positions().begin(), cloud.positions().end()};
}

/// Points of the rod have any normal or none, so that a sign that is carried round it may come back as the other one.
const std::string kFrustrated = "a rod on a sheet";

const std::map<std::string, Points>& bodies()
{
    static const std::map<std::string, Points> all{
        {"sheets half a spacing apart", together(sheet(1, 0), sheet(2, -0.5 * kSpacing))},
        {"sheets two spacings apart", together(sheet(1, 0), sheet(2, -2 * kSpacing))},
        {"noisy sheets four spacings apart", noisy(together(sheet(1, 0), sheet(2, -4 * kSpacing)), 0.3 * kSpacing)},
        {"a step in density by ten", together(sheet(1, 0, kSpacing, -20e-3, 0), sheet(2, 0, 10 * kSpacing, 0, 20e-3))},
        {kFrustrated, together(sheet(1, 0), rod())},
        {"an ellipsoid", cloudOf("ellipsoid")},
        {"a hand's palm", cloudOf("palm")},
    };
    return all;
}

/// Returns the points that a flood reaches in a ball, with the normals that it carries there.
using Reached = std::map<std::uint32_t, std::array<double, 3>>;

Reached flood(const SoftObject& object, const glm::dvec3& centre, double radius, const glm::dvec3& outward,
              double sparser)
{
    std::vector<std::uint32_t> ranks;
    object.index().gatherRanks(centre, radius, ranks);
    SurfaceFlood from(object);
    Reached      reached;
    const auto   found   = from.reachIn(ranks, centre, outward, sparser);
    const auto   normals = from.normals();
    for (std::size_t k = 0; k < found.size(); ++k)
        reached[ranks[found[k]]] = {normals[k].x, normals[k].y, normals[k].z};
    return reached;
}

/// A share of all points, whose steps are not kept, is flooded by searches: the same rule, and other code.
TEST(SurfaceLinks, LeadWhereASearchLeads)
{
    const double searched = std::nextafter(1.0, 2.0);
    for (const auto& [name, points] : bodies()) {
        const SoftObject object(PointCloud(points, std::vector<double>(points.size(), 1e6), StiffnessKind::modulus));
        std::mt19937_64  random(5);
        std::size_t      most = 0;
        for (int n = 0; n < 12; ++n) {
            const glm::dvec3 centre = points[random() % points.size()];
            const glm::dvec3 side(0, 0, n % 2 == 0 ? 1 : -1);
            const double     radius = (n % 3 + 1) * 6e-3;
            const Reached    links  = flood(object, centre, radius, side, 1),
                          search    = flood(object, centre, radius, side, searched);
            most                    = std::max(most, links.size());
            if (name != kFrustrated) {
                EXPECT_EQ(links, search) << name << ", ball " << n;
                continue;
            }
            std::size_t other = 0;
            for (const auto& [rank, normal] : links) other += search.contains(rank) ? 0 : 1;
            EXPECT_LT(double(other), 2e-3 * double(links.size())) << n << ": signs there depend on the way";
        }
        EXPECT_GT(most, 300U) << name;
    }
}

/// The walls are four spacings high, and their points see both faces: normals there say little. Where a point took the
/// sign of the one that came first, 1644 of the far face's 11 500 faced as the near one does, and were felt with it.
TEST(SurfaceFlood, CarriesItsSideAroundAThinClosedBox)
{
    constexpr double kGrid = 0.75e-3, kHigh = 1.5e-3, kLong = 30e-3, kWide = 20.25e-3; // [m], halves
    Points           points;
    for (int i = -40; i <= 40; ++i)
        for (int j = -27; j <= 27; ++j)
            for (int k = -2; k <= 2; ++k)
                if (std::abs(i) == 40 || std::abs(j) == 27 || std::abs(k) == 2)
                    points.push_back(kGrid * glm::dvec3(i, j, k));
    ASSERT_EQ(glm::dvec3(kLong, kWide, kHigh), -points.front());
    const SoftObject box(PointCloud(points, std::vector<double>(points.size(), 1e6), StiffnessKind::modulus));
    double           far = 0, turned = 0;
    for (const double x : {-24e-3, -18e-3, -10e-3, 0.0, 15e-3})
        for (const auto& [rank, normal] : flood(box, {x, 0, kHigh}, 22e-3, {0, 0, 1}, 1)) {
            if (box.index().positionsByRank()[rank].z > -kHigh * 0.99) continue;
            far += 1;
            turned += normal[2] > 0 ? 1 : 0;
        }
    EXPECT_GT(far, 10'000);
    EXPECT_EQ(turned, 0) << "464 while the walls were taken for noisy faces";
}

/// What is found first must not matter: neither the order of touches nor what they had in reach.
TEST(SurfaceLinks, DoNotDependOnWhatWasFloodedBefore)
{
    const Points     points = bodies().at("a step in density by ten");
    const PointCloud cloud(points, std::vector<double>(points.size(), 1e6), StiffnessKind::modulus);
    const SoftObject fresh(cloud), used(cloud);
    for (int n = 0; n < 40; ++n) (void)flood(used, points.at(std::size_t(n) * 131 % points.size()), 3e-3, {0, 0, 1}, 1);
    EXPECT_EQ(flood(fresh, {0, 0, 0}, 15e-3, {0, 0, 1}, 1), flood(used, {0, 0, 0}, 15e-3, {0, 0, 1}, 1));
}

TEST(SurfaceLinks, MayBeFoundByManyThreadsAtOnce)
{
    const Points         points = bodies().at("an ellipsoid");
    const PointCloud     cloud(points, std::vector<double>(points.size(), 1e6), StiffnessKind::modulus);
    const SoftObject     alone(cloud), shared(cloud);
    const auto           place = [&](std::size_t n) { return points[n * 2477 % points.size()]; };
    std::vector<Reached> found(8);
    {
        std::vector<std::jthread> threads;
        for (std::size_t n = 0; n < found.size(); ++n)
            threads.emplace_back([&, n] { found[n] = flood(shared, place(n), 15e-3, {0, 0, 1}, 1); });
    }
    for (std::size_t n = 0; n < found.size(); ++n)
        EXPECT_EQ(found[n], flood(alone, place(n), 15e-3, {0, 0, 1}, 1)) << n;
}

TEST(SurfaceLinks, AreSharedByObjectsOfTheSamePoints)
{
    const Points     points = sheet(1, 0);
    const SoftObject one(PointCloud(points, std::vector<double>(points.size(), 1e6), StiffnessKind::modulus));
    EXPECT_EQ(&one.links(), &one.repainted(std::vector<double>(points.size(), 2e6)).links());
    EXPECT_EQ(&one.links(), &one.withHeld({}).links());
}

} // namespace
} // namespace palp
