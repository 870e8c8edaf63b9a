#include "engine/cloud/local_spacing.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/cloud/point_sheets.h"

namespace palp {
namespace {

using namespace cloudtest;

std::vector<double> spacingsOf(const Points& points)
{
    const NeighbourIndex index(points);
    return localSpacings(index);
}

bool inside(const glm::dvec3& p, double x0, double x1)
{
    return p.x > x0 && p.x < x1 && std::abs(p.y) < 30;
}

TEST(LocalSpacing, IsTheMeanDistanceOfARandomSheetAndOfTwo)
{
    for (const double gap : {0.0, 2.0}) {
        Sheet  sheet(Layout::random, 3);
        Points points = sheet.whole();
        if (gap > 0) append(points, sheet.whole(), {0, 0, -gap});
        double mean = 0;
        for (const double s : spacingsOf(points)) {
            EXPECT_GT(s, 0.35) << "a random cloud is denser here and there";
            EXPECT_LT(s, 1.8);
            mean += s / double(points.size());
        }
        EXPECT_NEAR(mean, 1, 0.1);
    }
}

TEST(LocalSpacing, FollowsAStepInDensity)
{
    Sheet  sheet(Layout::random, 3);
    Points points = sheet.over(-kHalf, 0, -kHalf, kHalf);
    for (const glm::dvec3& p : sheet.over(0, 20, -20, 20)) points.push_back(2.0 * p);
    const std::vector<double> spacings = spacingsOf(points);
    const auto                mean     = [&](double x0, double x1) {
        double sum   = 0;
        int    count = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!inside(points[i], x0, x1)) continue;
            sum += spacings[i];
            ++count;
        }
        return sum / count;
    };
    EXPECT_NEAR(mean(-30, -6), 1, 0.1);
    EXPECT_NEAR(mean(8, 30), 2, 0.2);
}

TEST(LocalSpacing, OneStrayAndOnePairDoNotCount)
{
    Sheet  sheet(Layout::lattice, 3);
    Points points = sheet.whole();
    points.emplace_back(0, 0, 10);
    points.push_back(points[3000]);
    const std::vector<double> spacings = spacingsOf(points);
    EXPECT_LT(spacings[points.size() - 2], 1.5) << "the stray has the spacing of the sheet below it";
    EXPECT_GT(*std::min_element(spacings.begin(), spacings.end()), 0.7);
}

TEST(LocalSpacing, StraysFarFromEverythingHaveTheOthersSpacing)
{
    Points points = ball(Layout::random, 30, 3.2, 3);
    for (const glm::dvec3& stray : {glm::dvec3(900, 0, 0), glm::dvec3(0, 0, 400), glm::dvec3(0, -60, 0)})
        points.push_back(stray);
    const std::vector<double> spacings = spacingsOf(points);
    EXPECT_LT(*std::max_element(spacings.begin(), spacings.end()), 2) << "one at 900 had 700, and held every hand";
}

/// Returns the coarse points, `ratio` apart, whose spacing is less than a third of that.
int takenForStrays(const Points& fine, const Points& coarse, double ratio)
{
    Points points = fine;
    append(points, coarse);
    const std::vector<double> spacings = spacingsOf(points);
    return int(std::count_if(spacings.begin() + std::ptrdiff_t(fine.size()), spacings.end(),
                             [=](double s) { return 3 * s < ratio; }));
}

Points scaled(Points points, double by)
{
    for (glm::dvec3& p : points) p *= by;
    return points;
}

/// A few points beside a step lie where the dense side has most of the area, and the balls of the next ones reach over
/// them: as many as before there were strays to tell, and a fifth more at most.
TEST(LocalSpacing, WhatIsCoarseOnPurposeIsNoStray)
{
    for (const Layout layout : {Layout::lattice, Layout::random})
        for (const double ratio : {4.0, 10.0}) {
            SCOPED_TRACE("1:" + std::to_string(ratio));
            Sheet        sheet(layout, 7);
            const Points fine   = sheet.whole();
            const auto   lost   = [&](const Points& coarse) { return takenForStrays(fine, coarse, ratio); };
            const Points beside = scaled(sheet.over(kHalf / ratio, kHalf / ratio + 8, -8, 8), ratio); // 128 points
            EXPECT_LE(lost(beside), 18);
            Points rough = beside;
            addNoise(rough, 0.3 * ratio, sheet.random());
            EXPECT_LE(lost(rough), 22);
            Points thin = beside;
            append(thin, beside, {0.3, 0.2, -1.5 * ratio});
            EXPECT_LE(lost(thin), 24) << "two sheets";
            Points wall; // at a right angle, as a coarse side of a box
            for (const glm::dvec3& p : sheet.over(-8, 8, 0.2, 12))
                wall.push_back(ratio * glm::dvec3(0, p.x, -p.y) + glm::dvec3(kHalf, 0, 0));
            EXPECT_LE(lost(wall), 25) << "of 192";
            for (const double radius : {3.0, 5.0}) {
                Points round;
                append(round, scaled(ball(layout, radius, 3.2, 5), ratio), {60 + 2 * radius * ratio, 0, 0});
                EXPECT_LE(lost(round), 1) << "a ball of radius " << radius;
            }
        }
}

TEST(LocalSpacing, OfAFarDenserPartIsItsOwn)
{
    Sheet        sheet(Layout::random, 3);
    Points       points = sheet.whole();
    const double finer  = 1e-6;
    const auto   sparse = points.size();
    for (const glm::dvec3& p : sheet.whole()) points.push_back(finer * p + glm::dvec3(0.3, 0.2, 5));
    const std::vector<double> spacings = spacingsOf(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double own = i < sparse ? 1 : finer;
        EXPECT_GT(spacings[i], 0.35 * own);
        EXPECT_LT(spacings[i], 1.8 * own);
    }
}

TEST(LocalSpacing, NeedsASurface)
{
    EXPECT_THROW((void)spacingsOf(Points(100, glm::dvec3(1, 2, 3))), Error);
    EXPECT_THROW((void)spacingsOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), Error);
}

} // namespace
} // namespace palp
