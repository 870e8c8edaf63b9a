#include "engine/contact/detail/point_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

/// A random sheet of 40 x 40 whose spacing is 1/30 in a disc of radius 2 and 1 elsewhere, a little rough.
struct Cloud {
    std::vector<glm::dvec3> positions;
    std::vector<double>     spacings;

    Cloud()
    {
        std::mt19937_64                  random(3);
        std::uniform_real_distribution<> unit(-1, 1);
        std::normal_distribution<>       normal;
        for (int i = 0; i < 1600; ++i) add({20 * unit(random), 20 * unit(random), 0.1 * normal(random)}, 1);
        for (int i = 0; i < 14400; ++i) {
            const glm::dvec3 p(2 * unit(random), 2 * unit(random), 0.003 * normal(random));
            if (std::hypot(p.x, p.y) < 2) add(p, 1.0 / 30);
        }
    }
    void add(const glm::dvec3& p, double spacing)
    {
        positions.push_back(p);
        spacings.push_back(spacing);
    }
};

using Place = std::array<double, 3>;
Place key(const glm::dvec3& p)
{
    return {p.x, p.y, p.z};
}

std::vector<glm::dvec3> places()
{
    std::mt19937_64            random(5);
    std::normal_distribution<> normal;
    std::vector<glm::dvec3>    places;
    for (int i = 0; i < 200; ++i) places.emplace_back(3 * normal(random), 3 * normal(random), 0.5 * normal(random));
    return places;
}

TEST(PointTree, FindsThePointsOfABallAndTheBallsAboutAPlace)
{
    const Cloud     cloud;
    const PointTree tree(cloud.positions, cloud.spacings);
    for (const glm::dvec3& place : places()) {
        std::set<Place> inside, holding, foundInside, foundHolding;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
            const double distance = glm::length(cloud.positions[i] - place);
            if (distance < 0.7) inside.insert(key(cloud.positions[i]));
            if (distance < kBall * cloud.spacings[i]) holding.insert(key(cloud.positions[i]));
        }
        tree.inside(place, 0.7, 0, [&](const NearPoint& p) { return foundInside.insert(key(p.position)).second; });
        tree.holding(place, [&](const NearPoint& p, double) { foundHolding.insert(key(p.position)); });
        EXPECT_EQ(foundInside, inside);
        EXPECT_EQ(foundHolding, holding);
    }
}

TEST(PointTree, ALargeCloudIsBuiltByThreadsAndSearchedAlike)
{
    // So many that other threads build parts of the tree, a sheet whose points are 1 apart.
    std::mt19937_64                  random(7);
    std::uniform_real_distribution<> unit(-200, 200);
    std::vector<glm::dvec3>          positions;
    for (int i = 0; i < 160'000; ++i) positions.emplace_back(unit(random), unit(random), 0.01 * unit(random));
    const PointTree tree(positions, std::vector<double>(positions.size(), 1));
    for (int k = 0; k < 20; ++k) {
        const glm::dvec3 place(unit(random), unit(random), 0);
        std::set<Place>  inside, found;
        for (const glm::dvec3& p : positions)
            if (glm::length(p - place) < 6) inside.insert(key(p));
        tree.inside(place, 6, 0, [&](const NearPoint& p) { return found.insert(key(p.position)).second; });
        EXPECT_EQ(found, inside);
        EXPECT_LT(tree.firstTouch(place + glm::dvec3(0, 0, 20), place - glm::dvec3(0, 0, 20)), 1);
    }
}

TEST(PointTree, AWayEndsAtTheFirstBallThatItEnters)
{
    const Cloud     cloud;
    const PointTree tree(cloud.positions, cloud.spacings);
    int             touched = 0;
    for (const glm::dvec3& place : places()) {
        const glm::dvec3 from = place + glm::dvec3(0, 0, 6), to = place - glm::dvec3(1, 0, 6);
        const double     share = tree.firstTouch(from, to);
        // Outside of all balls until there, in steps of a thousandth; and in one just behind.
        const auto held = [&](double at) {
            bool any = false;
            tree.holding(from + at * (to - from), [&](const NearPoint&, double) { any = true; });
            return any;
        };
        for (double at = 0; at < share - 1e-3; at += 1e-3) ASSERT_FALSE(held(at)) << at << " of " << share;
        EXPECT_TRUE(share == 1 || held(share + 1e-9));
        touched += share < 1;
    }
    EXPECT_GT(touched, 150);
}

TEST(PointTree, ALevelCoversTheDenseDiscWithFewPoints)
{
    const Cloud     cloud;
    const PointTree tree(cloud.positions, cloud.spacings);
    ASSERT_TRUE(tree.mixed());
    const int level = tree.level(1), all = tree.level(1.0 / 30);
    EXPECT_EQ(all, 0);
    EXPECT_EQ(tree.cell(0), 0) << "all points stand for themselves";
    EXPECT_NEAR(tree.cell(level), 0.375, 0.125 * (1 + 1e-9)) << "from a quarter to a half of the look's spacing";
    std::vector<glm::dvec3> shown;
    tree.inside({0, 0, 0}, 2, level, [&](const NearPoint& p) {
        shown.push_back(p.position);
        return true;
    });
    // Cubes with sides of a quarter to a half of the look's spacing; a rough sheet crosses two layers of them.
    EXPECT_LT(shown.size(), std::size_t(2.5 * std::numbers::pi * 4 * 16));
    EXPECT_GT(shown.size(), std::size_t(0.5 * std::numbers::pi * 4 * 4));
    for (const glm::dvec3& p : cloud.positions) {
        if (glm::length(p) > 1.5) continue;
        double nearest = 1e9;
        for (const glm::dvec3& q : shown) nearest = std::min(nearest, glm::length(p - q));
        EXPECT_LT(nearest, 0.5 * std::sqrt(3.0)) << "the diagonal of a cube";
    }
}

TEST(PointTree, StackedPointsAreThinnedAndSparseOnesAllShownAtTheirLevel)
{
    Cloud cloud;
    for (int i = 0; i < 5000; ++i) cloud.add({0.5, 0.5, 0.001 * (i % 7)}, 1.0 / 30);
    const PointTree tree(cloud.positions, cloud.spacings);
    int             near = 0, sparse = 0;
    tree.inside({0.5, 0.5, 0}, 1.0 / 30, 0, [&](const NearPoint&) { return ++near > 0; });
    EXPECT_LT(near, 500) << "of 5000; stacks over the box tree's borders count twice";
    tree.inside({0, 0, 0}, 100, tree.level(1), [&](const NearPoint& p) {
        sparse += p.spacing == 1;
        return true;
    });
    EXPECT_EQ(sparse, 1600);
}

} // namespace
} // namespace palp
