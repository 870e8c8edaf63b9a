// The points that a proxy touches. Lengths are in spacings.
#include "engine/contact/detail/contact_points.h"

#include <gtest/gtest.h>

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
}

TEST(ContactPoints, NoisyPointsAreSmoothed)
{
    Sheet  sheet(Layout::lattice, 3);
    Points points = sheet.over(-30, 30, -30, 30);
    addNoise(points, 0.3, sheet.random());
    const SoftObject object = objectOf(points);

    const ContactPoints touched(object);

    EXPECT_LT(touched.positions().size(), points.size() / 4) << "one for each square of a touch scale of 3.3 spacings";
}

} // namespace
} // namespace palp
