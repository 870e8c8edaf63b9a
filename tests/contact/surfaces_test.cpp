#include "engine/contact/detail/surfaces.h"

#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/contact/detail/contact_points.h"
#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

SurfacePlane plane(const glm::dvec3& normal, const glm::dvec3& foot)
{
    return {glm::normalize(normal), foot, 1};
}

TEST(RestOn, AHandInFrontOfAllPlanesRestsOnNone)
{
    const SurfacePlane planes[] = {plane({0, 0, 1}, {0, 0, 0}), plane({1, 0, 0}, {0, 0, 0})};
    const RestPoint    rest     = restPointOn(planes, {1, 2, 3});
    EXPECT_FALSE(rest.touching());
    EXPECT_EQ(rest.point, glm::dvec3(1, 2, 3));
    EXPECT_FALSE(restPointOn({}, {1, 2, 3}).touching());
}

TEST(RestOn, OnePlaneTwoPlanesThreePlanes)
{
    const SurfacePlane planes[] = {plane({0, 0, 1}, {0, 0, 0}), plane({1, 0, 0}, {0, 0, 0}),
                                   plane({0, 1, 0}, {0, 0, 0})};
    EXPECT_EQ(restPointOn(planes, {1, 2, -3}).point, glm::dvec3(1, 2, 0));
    EXPECT_EQ(restPointOn(planes, {-1, 2, -3}).point, glm::dvec3(0, 2, 0));
    EXPECT_EQ(restPointOn(planes, {-1, -2, -3}).point, glm::dvec3(0, 0, 0));
    EXPECT_EQ(restPointOn(planes, {-1, -2, -3}).load[0], 3) << "how deep the hand is behind it";
}

TEST(RestOn, IsTheNearestPlaceThatIsBehindNothing)
{
    std::mt19937_64            random(1);
    std::normal_distribution<> normal;
    const auto                 any = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
    for (int run = 0; run < 300; ++run) {
        const SurfacePlane planes[] = {plane(any(), 0.2 * any()), plane(any(), 0.2 * any()), plane(any(), 0.2 * any())};
        const glm::dvec3   hip      = any();
        const RestPoint    rest     = restPointOn(planes, hip);
        for (const SurfacePlane& p : planes) EXPECT_GT(p.height(rest.point), -1e-9);
        for (int trial = 0; trial < 300; ++trial) {
            const glm::dvec3 other = rest.point + 0.3 * any();
            if (planes[0].height(other) < 0 || planes[1].height(other) < 0 || planes[2].height(other) < 0) continue;
            EXPECT_GE(glm::length(other - hip), glm::length(rest.point - hip) - 1e-9);
        }
    }
}

TEST(SurfaceTracker, DropsACeilingThatHasComeDownToTheFloor)
{
    using namespace proxytest;
    Sheet  sheet(Layout::random, 3);
    Points points = sheet.over(-20, 20, -20, 20);
    for (glm::dvec3& p : points) p *= kSpacing;
    const std::vector<double> stiffness(points.size(), 1e6);
    const SoftObject          object(PointCloud(std::move(points), stiffness, StiffnessKind::modulus));
    NearPoints                near{ContactPoints(object)};
    SurfaceTracker            tracker(near);
    for (const double height : {0.2, 8.0}) { // [spacings]
        Surfaces surfaces;
        surfaces.spacing   = kSpacing;
        surfaces.planes[0] = plane({0, 0, 1}, {0, 0, 0});
        surfaces.planes[1] = plane({0, 0, -1}, {0, 0, height * kSpacing});
        surfaces.count     = 2;
        tracker.refresh(surfaces, {0, 0, 0.1 * kSpacing});
        EXPECT_EQ(surfaces.count, height < 1 ? 1 : 2) << height;
        EXPECT_GT(surfaces.planes[0].normal.z, 0.99);
    }
}

TEST(RestOn, PlanesThatContradictEachOtherGiveAnAnswerAllTheSame)
{
    const SurfacePlane planes[] = {plane({0, 0, 1}, {0, 0, 0}), plane({0, 0, -1}, {0, 0, -1})};
    const RestPoint    rest     = restPointOn(planes, {0, 0, -0.2});
    EXPECT_TRUE(std::isfinite(rest.point.z));
}

} // namespace
} // namespace palp
