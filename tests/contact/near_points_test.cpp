// The points about a place. Lengths are in spacings.
#include "engine/contact/detail/near_points.h"

#include <cstddef>

#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

/// A servo's vectors may not grow: of a ball with too many points a coarser level is taken, whose points stand for them.
TEST(NearPoints, ABallWithTooManyPointsIsSeenMoreCoarsely)
{
    Sheet  sheet(Layout::lattice, 3);
    Points points = sheet.over(-60, 60, -60, 60);
    for (glm::dvec3& p : points) p *= kSpacing;
    const std::vector<double> stiffness(points.size(), 1e6);
    const SoftObject          object(PointCloud(points, stiffness, StiffnessKind::modulus));
    const ContactPoints       touched(object);
    NearPoints                near(touched);
    const auto                count = [&](double radius) {
        std::size_t found = 0;
        near.inside({}, radius * kSpacing, kSpacing, [&](const NearPoint&, double) { ++found; });
        return found;
    };

    EXPECT_NEAR(double(count(20)), 1257, 50) << "one for each square of a spacing";
    EXPECT_LE(count(55), NearPoints::kMost) << "of some 9500";
    EXPECT_GT(count(55), NearPoints::kMost / 8) << "and they are not lost";
}

} // namespace
} // namespace palp
