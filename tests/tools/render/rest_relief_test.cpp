#include "engine/tools/render/rest_relief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/uniform.h"

namespace palp {
namespace {

struct Points {
    std::vector<glm::dvec3> positions, normals; // [m], [1]
};

/// Strewn evenly over a ball.
Points ball(double radius, std::size_t count)
{
    Points  ball;
    Uniform random(5);
    for (std::size_t n = 0; n < count; ++n) {
        const double     z = random(-1, 1), angle = random(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
        const glm::dvec3 out(r * std::cos(angle), r * std::sin(angle), z);
        ball.positions.push_back(radius * out);
        ball.normals.push_back(out);
    }
    return ball;
}

double mean(const std::vector<double>& values)
{
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / double(values.size());
}

/// Of a surface of curvature 1/R every place at distance d lies d²/2R below the tangent plane.
double reliefOfBall(double ballRadius, double reach)
{
    double        sum = 0, weights = 0;
    constexpr int kSteps = 10000;
    for (int n = 0; n < kSteps; ++n) {
        const double d = reach * (n + 0.5) / kSteps, weight = (1 - d / (2 * reach)) * d; // rings grow with d
        sum -= weight * d * d / (2 * ballRadius) / (d + 0.1 * reach);
        weights += weight;
    }
    return sum / weights;
}

TEST(RestRelief, OfABallIsThatOfItsCurvatureAtBothReaches)
{
    constexpr double kBall = 0.05, kReach = 0.002; // [m]
    constexpr int    kCount   = 40000;
    const Points     points   = ball(kBall, kCount);
    const double     spacing  = kBall * std::sqrt(4 * std::numbers::pi / kCount);
    const double     expected = reliefOfBall(kBall, kReach) + reliefOfBall(kBall, 3.5 * kReach);
    // Some forty random places each: the mean over all points wanders by about 1 %.
    EXPECT_NEAR(mean(restRelief(points.positions, points.normals, spacing, kReach)) / expected, 1, 0.03);
}

TEST(RestRelief, SeenFromInsideItIsAHollow)
{
    Points points = ball(0.05, 10000);
    for (glm::dvec3& normal : points.normals) normal = -normal;
    EXPECT_GT(std::ranges::min(restRelief(points.positions, points.normals, 1.8e-3, 0.005)), 0);
}

TEST(RestRelief, TheOtherSideOfASheetIsNoHump)
{
    Points  points;
    Uniform random(5);
    for (int n = 0; n < 8000; ++n) { // two sides of a sheet, 40 mm wide and 1 mm thick
        const double side = n % 2 ? 1 : -1;
        points.positions.emplace_back(random(-0.02, 0.02), random(-0.02, 0.02), side * 0.0005);
        points.normals.emplace_back(0, 0, side);
    }
    for (const double relief : restRelief(points.positions, points.normals, 0.4e-3, 0.002))
        ASSERT_LT(std::abs(relief), 1e-12) << "a plane, but for rounding";
}

TEST(RestRelief, AFewPointsFarApartHaveNone)
{
    const std::vector<glm::dvec3> positions{{0, 0, 0}, {1, 0, 0}}, normals{{0, 0, 1}, {0, 0, 1}};
    EXPECT_EQ(restRelief(positions, normals, 1, 1e-6), (std::vector<double>{0, 0}));
}

} // namespace
} // namespace palp
