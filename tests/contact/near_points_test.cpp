// The points about a place. Lengths are in spacings.
#include "engine/contact/detail/near_points.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

/// A servo's vectors may not grow: of a ball with too many points a coarser level is taken, whose points stand for
/// them.
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

/// Balls are kept by their level modulo a few: one of another level must not be taken for the one asked for.
TEST(NearPoints, WhatWasAskedBeforeChangesNothing)
{
    Points points; // ever sparser outward, by a thousand
    for (double radius = 0.1; radius < 100; radius *= 1.1)
        for (int k = 0; k < 60; ++k) {
            const double angle = 2 * std::numbers::pi * k / 60;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        }
    for (glm::dvec3& p : points) p *= kSpacing;
    const std::vector<double> stiffness(points.size(), 1e6);
    const SoftObject          object(PointCloud(points, stiffness, StiffnessKind::modulus));
    const NearPoints          fresh{ContactPoints(object)};
    const auto                found = [&](NearPoints& near, double scale) { // [spacings]
        std::vector<double> spacings;
        near.inside({}, 5 * kSpacing, scale * kSpacing,
                                   [&](const NearPoint& p, double) { spacings.push_back(p.spacing); });
        return spacings;
    };
    NearPoints            asked = fresh;
    std::set<std::size_t> counts;
    for (double scale = 0.01; scale < 16; scale *= 2)
        for (const double other : {scale, scale / 16}) {
            NearPoints once = fresh;
            EXPECT_EQ(found(asked, other), found(once, other)) << other;
            counts.insert(found(once, other).size());
        }
    EXPECT_GT(counts.size(), 6U) << "levels that differ";
}

} // namespace
} // namespace palp
