#include "engine/cloud/extent.h"

#include <cmath>
#include <random>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

/// Points a millimetre apart where a shape has some, turned.
template <class Shape>
std::vector<glm::dvec3> pointsOf(const Shape& has, double turn)
{
    const glm::dquat        by = glm::angleAxis(turn, glm::normalize(glm::dvec3(1, 2, 3)));
    std::vector<glm::dvec3> points;
    for (int i = -60; i <= 60; ++i)
        for (int j = -60; j <= 60; ++j)
            if (has(i * 1e-3, j * 1e-3)) points.push_back(by * glm::dvec3(i * 1e-3, j * 1e-3, 0.01));
    return points;
}

/// The raster of points makes both up to half a spacing in 40 wrong, and on any turn alike.
TEST(Extent, IsThatOfTheShapeHoweverItIsTurned)
{
    const auto square = [](double x, double z) { return std::abs(x) <= 0.03 && std::abs(z) <= 0.03; };
    const auto strip  = [](double x, double z) { return std::abs(x) <= 0.05 && std::abs(z) <= 0.004; };
    const auto disc   = [](double x, double z) { return std::hypot(x, z) <= 0.04; };
    const auto ring   = [](double x, double z) { return std::hypot(x, z) <= 0.05 && std::hypot(x, z) >= 0.047; };
    for (const double turn : {0.0, 0.6, 2.5}) {
        const auto of = [&](const auto& shape) { return extentOf(pointsOf(shape, turn), {}); };
        EXPECT_NEAR(of(square).across, 0.06 * std::sqrt(2.0), 1e-12);
        EXPECT_NEAR(of(square).length, 0.06 * std::sqrt(2.0), 2e-3);
        EXPECT_NEAR(of(strip).across, std::hypot(0.1, 0.008), 1e-12);
        EXPECT_NEAR(of(strip).length, 0.1, 2e-3);
        EXPECT_NEAR(of(disc).across, 0.08, 1e-3);
        EXPECT_NEAR(of(disc).length, 0.08 * std::sqrt(1.5), 2e-3);
        EXPECT_NEAR(of(ring).length, of(ring).across * std::sqrt(2.0), 1e-12);
    }
}

TEST(Extent, CountsThePointsByTheirAreas)
{
    // One half of a strip four times as dense, each point of which stands for a quarter.
    std::vector<glm::dvec3> points;
    std::vector<double>     spacings;
    for (int n = 0; n < 400; ++n) {
        points.emplace_back((n + 0.5) * 0.25e-3, 0, 0);
        spacings.push_back(0.5e-3);
    }
    for (int n = 0; n < 100; ++n) {
        points.emplace_back(0.1 + (n + 0.5) * 1e-3, 0, 0);
        spacings.push_back(1e-3);
    }
    EXPECT_NEAR(extentOf(points, spacings).length, 0.2, 2e-4);
    EXPECT_LT(extentOf(points, {}).length, 0.19);
}

TEST(Extent, OfNoPointsOrOneIsNone)
{
    const std::vector<glm::dvec3> one{{1, 2, 3}};
    EXPECT_EQ(extentOf({}, {}).across, 0);
    EXPECT_EQ(extentOf(one, {}).across, 0);
    EXPECT_EQ(extentOf(one, {}).length, 0);
}

} // namespace
} // namespace palp
