// Points as scanners and slices leave them: along lines, and several at one place. Lengths are in millimetres.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

/// A square of 90 on lines along x, with noise of a laser scanner.
Points lines(double along, double between)
{
    std::mt19937_64            random(5);
    std::normal_distribution<> noise(0, 0.02);
    Points                     points;
    for (double y = -45; y < 45; y += between)
        for (double x = -45; x < 45; x += along) points.emplace_back(x, y, noise(random));
    return points;
}

/// Of 100 presses at random places those that are not held at the plane.
int missedPresses(Touch& touch, double half, double deep)
{
    std::mt19937_64                  random(1);
    std::uniform_real_distribution<> unit(-half, half);
    int                              missed = 0;
    for (int press = 0; press < 100; ++press) {
        const double x = unit(random), y = unit(random);
        touch.start({x, y, 10});
        touch.move({x, y, -deep}, 0.1);
        missed += !touch.touching() || std::abs(touch.at().z) > 0.3;
    }
    return missed;
}

TEST(ProxyLines, LinesAreASurface)
{
    for (const auto& [along, between] : {std::pair(0.2, 1.5), {0.1, 3.0}}) {
        Touch             touch(lines(along, between));
        const std::string ratio = std::to_string(between / along);
        EXPECT_EQ(missedPresses(touch, 30, 5), 0) << "lines " << ratio << " times as far apart as their points";
        Runs runs;
        for (const glm::dvec3& way : {glm::dvec3(0, 40, 0), {40, 0, 0}, {28, 28, 0}})
            runs.add(slideFlat(touch, -0.5 * way, way, 5, 0.1));
        SCOPED_TRACE(record(runs, ratio));
        EXPECT_EQ(runs.popped, 0);
        EXPECT_LT(runs.worstRipple, 0.01) << "half the noise, as a fit holds hundreds of points";
        EXPECT_LT(runs.all.angle(), 0.5);
    }
}

TEST(ProxyLines, PointsThatLieOnOneAnotherCountOnce)
{
    Sheet  sheet(Layout::random, 3);
    Points points = sheet.over(-15, 15, -15, 15);
    addNoise(points, 0.1, sheet.random());
    for (const int copies : {2, 6, 8}) {
        Points stacked;
        for (int copy = 0; copy < copies; ++copy) append(stacked, points);
        Touch once(points), often(stacked);
        for (Touch* touch : {&once, &often}) touch->start({-8, 0.3, 5});
        for (const glm::dvec3& to : {glm::dvec3(-8, 0.3, -3), {8, 1.3, -3}, {12, 1.3, 4}})
            once.move(to, 0.3, [&] {
                often.step(once.hip());
                ASSERT_EQ(once.touching(), often.touching()) << copies << " copies";
                ASSERT_EQ(once.pull(), often.pull()) << copies << " copies";
            });
    }
}

} // namespace
} // namespace palp
