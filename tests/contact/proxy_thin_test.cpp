// Thin bodies: two random sheets closer together than the heights at which points count. Lengths are in spacings.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

Points thinBody(double gap, double half, std::uint64_t seed)
{
    Sheet  sheet(Layout::random, seed);
    Points points = sheet.over(-half, half, -half, half);
    append(points, sheet.over(-half, half, -half, half), {0, 0, -gap});
    return points;
}

/// How 100 presses from above went wrong.
struct Wrong {
    int passed = 0; ///< lost in the end
    int began  = 0; ///< first touched the far sheet
    int ended  = 0; ///< held by the far sheet
    int any    = 0; ///< presses with any of these
};

void PrintTo(const Wrong& wrong, std::ostream* out)
{
    *out << wrong.any << " wrong: passed " << wrong.passed << ", began " << wrong.began << ", ended " << wrong.ended;
}

Wrong presses(double gap, double speed)
{
    Wrong wrong;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        Touch touch(thinBody(gap, 20, 6000 + seed), {}, {3.7, -2.9, 13.3});
        for (int place = 0; place < 10; ++place) {
            const glm::dvec3 at(-9 + 2 * place, 0.3 * place, 0);
            bool             touched = false, began = false;
            touch.start(at + glm::dvec3(0, 0, 5));
            touch.move(at - glm::dvec3(0, 0, gap + 5), speed, [&] {
                if (touch.touching() && !touched) began = touch.at().z < -0.75 * gap;
                touched = touched || touch.touching();
            });
            const bool passed = !touch.touching(), ended = !passed && touch.at().z < -0.5 * gap;
            wrong.passed += passed;
            wrong.began += began;
            wrong.ended += ended;
            wrong.any += passed || began || ended;
        }
    }
    return wrong;
}

TEST(ProxyThin, PressesFindTheNearFace)
{
    for (const double speed : {0.1, 0.5})
        for (const auto& [gap, most] : {std::pair(2.0, 0), {1.0, 1}, {0.5, 5}}) {
            const Wrong       wrong = presses(gap, speed);
            const std::string name  = "gap " + std::to_string(gap) + ", speed " + std::to_string(speed);
            SCOPED_TRACE(record(testing::PrintToString(wrong), name));
            EXPECT_LE(wrong.any, most);
        }
}

TEST(ProxyThin, AHandInsideAShellFeelsIt)
{
    // All points face away from the hand: that is a preference, and no reason to let it pass.
    const double           radius = 8;
    Points                 points = ball(Layout::random, radius, std::numbers::pi, 5);
    std::vector<glm::vec3> normals;
    for (glm::dvec3& p : points) {
        p.z += radius;
        normals.push_back(glm::vec3(p / radius));
    }
    Touch touch(points, {}, glm::dvec3(0), normals);
    for (const glm::dvec3& way : {glm::dvec3(1, 0, 0), {0, -1, 0}, {0.6, 0, 0.8}, {-0.48, 0.6, -0.64}}) {
        touch.start({0, 0, 0});
        touch.move((radius + 3) * way, 0.2);
        EXPECT_TRUE(touch.touching());
        EXPECT_NEAR(glm::length(touch.at()), radius, 0.4);
        EXPECT_LT(glm::dot(touch.state().normal, way), -0.9);
    }
}

/// Over ten sheets: a press at one place of one sheet is off by up to half a spacing at the border of the flipped
/// faces.
TEST(ProxyThin, FlippedFacesOpenNoHoles)
{
    constexpr double kDepth = 5;
    for (const double flipped : {1.0, 5.0}) {
        double least = kDepth, square = 0, count = 0;
        for (std::uint64_t seed = 9; seed < 19; ++seed) {
            Sheet                  sheet(Layout::random, seed);
            const Points           points = sheet.over(-25, 25, -25, 25);
            std::vector<glm::vec3> normals;
            for (const glm::dvec3& p : points) normals.emplace_back(0, 0, std::hypot(p.x, p.y) < flipped ? -1 : 1);
            Touch touch(points, {}, {3.7, -2.9, 13.3}, normals);
            touch.start({-15, 0.3, 5});
            touch.move({-15, 0.3, -kDepth}, 0.5);
            touch.move({15, 0.3, -kDepth}, 0.1, [&] { least = std::min(least, touch.pull().z); });
            for (const double x : {-5.0, -2.0, 0.0, 3.0}) {
                touch.start({x, 0, 5});
                touch.move({x, 0, -kDepth}, 0.1);
                square += (touch.pull().z - kDepth) * (touch.pull().z - kDepth);
                ++count;
            }
        }
        SCOPED_TRACE(record(std::to_string(least), "flipped within " + std::to_string(flipped)));
        EXPECT_GT(least, 0.85 * kDepth);
        EXPECT_LT(std::sqrt(square / count), 0.1) << "0.06 is what random sheets have";
    }
}

TEST(ProxyThin, AThinBodyIsSmooth)
{
    for (const double gap : {1.0, 0.5}) {
        Runs runs;
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            Touch touch(thinBody(gap, 25, 6100 + seed), {}, {3.7, -2.9, 13.3});
            runs.add(slideFlat(touch, {-15, 0.3, 0}, {30, 0, 0}, 5, 0.1));
        }
        SCOPED_TRACE(record(runs, "gap " + std::to_string(gap)));
        EXPECT_LT(runs.all.ripple(), 0.03);
    }
}

/// What a hand close over a sheet has seen holds nothing beyond its border: it would be a touch of no force, after
/// which the proxy is where the hand is.
TEST(ProxyThin, ASheetThatEndsHidesNoneBelow)
{
    for (int seed = 0; seed < kSeeds; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Sheet  sheet(Layout::random, kFirstSeed + std::uint64_t(seed));
        Points points = sheet.over(-15, 0, -15, 15);
        append(points, sheet.over(-15, 15, -15, 15), {0, 0, -4});
        Touch touch(points);
        touch.start({-5, 0.3, 5});
        touch.move({-5, 0.3, 0.6}, 0.2);
        touch.move({4, 0.3, 0.6}, 0.2, [&] { EXPECT_FALSE(touch.touching()); });
        touch.step({4, 0.3, -8});
        EXPECT_TRUE(touch.touching());
        EXPECT_NEAR(touch.at().z, -4, 0.3);
    }
}

} // namespace
} // namespace palp
