// The points that a proxy touches. Lengths are in spacings.
#include "engine/contact/detail/contact_points.h"

#include <algorithm>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/contact/detail/surface_projector.h"
#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

SoftObject objectOf(Points points)
{
    for (glm::dvec3& p : points) p *= kSpacing;
    const std::vector<double> stiffness(points.size(), 1e6);
    return SoftObject(PointCloud(std::move(points), stiffness, StiffnessKind::modulus));
}

TEST(ContactPoints, PointsOfAGoodScanStayAsTheyAre)
{
    Sheet  sheet(Layout::lattice, 3);
    Points points = sheet.over(-30, 30, -30, 30);
    addNoise(points, 0.06, sheet.random());
    const SoftObject object = objectOf(points);

    const ContactPoints touched(object);

    EXPECT_EQ(touched.positions().data(), object.positions().data()) << "clean points are the object's own";
    for (const PointMark& mark : touched.marks()) EXPECT_EQ(mark.smoothed, 0);
}

TEST(ContactPoints, NoisyPointsAreSmoothed)
{
    Sheet  sheet(Layout::lattice, 3);
    Points points = sheet.over(-30, 30, -30, 30);
    addNoise(points, 0.3, sheet.random());
    const SoftObject object = objectOf(points);

    const ContactPoints touched(object);

    EXPECT_LT(touched.positions().size(), points.size() / 4) << "one for each square of a touch scale of 3.3 spacings";
    ASSERT_EQ(touched.marks().size(), touched.positions().size());
    const auto smoothed = std::ranges::count_if(touched.marks(), [](const PointMark& mark) { return mark.smoothed; });
    EXPECT_GT(smoothed, std::ptrdiff_t(touched.marks().size()) * 9 / 10)
        << "they have little noise, and planes know it";
}

/// Lengths are in scales of a touch.
TEST(ContactPoints, ASheetBehindANoisyOneDoesNotPullItDown)
{
    std::mt19937_64                  random(1);
    std::normal_distribution<>       noise(0, 1.0 / 11);
    std::uniform_real_distribution<> side(-3, 3);
    for (int run = 0; run < 20; ++run) {
        SurfaceProjector projector;
        for (const double height : {0.0, -2.0})
            for (int k = 0; k < 400; ++k) {
                const glm::dvec3 away(side(random), side(random), height + noise(random));
                if (glm::length(away) < SurfaceProjector::reach(1)) projector.add(away);
            }
        const auto way = projector.wayToSurface(1);
        ASSERT_TRUE(way) << run;
        EXPECT_LT(glm::length(*way), 0.06) << "five times what 300 points leave of the noise; " << run;
    }
}

} // namespace
} // namespace palp
