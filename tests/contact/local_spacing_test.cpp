#include "engine/cloud/local_spacing.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

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

TEST(LocalSpacing, NeedsASurface)
{
    EXPECT_THROW((void)spacingsOf(Points(100, glm::dvec3(1, 2, 3))), Error);
    EXPECT_THROW((void)spacingsOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), Error);
}

} // namespace
} // namespace palp
