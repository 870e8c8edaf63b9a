#include "engine/cloud/cloud_quality.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace palp {
namespace {

SoftObject objectOf(std::vector<glm::dvec3> points)
{
    std::vector<double> stiffness(points.size(), 1e5);
    return SoftObject(PointCloud(std::move(points), std::move(stiffness), StiffnessKind::modulus));
}

/// A square lattice about the origin, `half` points to each side, without the points within `hole` [m] of the origin.
std::vector<glm::dvec3> lattice(int half, double step, double hole = 0)
{
    std::vector<glm::dvec3> points;
    for (int i = -half; i <= half; ++i)
        for (int j = -half; j <= half; ++j)
            if (std::hypot(i * step, j * step) >= hole) points.emplace_back(i * step, j * step, 0);
    return points;
}

TEST(CloudQuality, ALatticeHasItsStepAndTheAreaOfItsSquare)
{
    const CloudQuality q = cloudQuality(objectOf(lattice(50, 1e-3)));
    // d6 = sqrt(2) steps, so 1.023 steps by localSpacings(); a little more along the border.
    EXPECT_NEAR(q.spacing.typical, 1e-3, 0.03e-3);
    EXPECT_NEAR(q.spacing.low, q.spacing.high, 0.01e-3) << "even: the border is less than 5 % of the area";
    EXPECT_NEAR(q.area, 0.1 * 0.1, 0.1 * 0.01) << "100 steps a side; 5 % by the spacing's bias, 2 % by the border";
    EXPECT_NEAR(q.pointsUnder(4e-3), 3.14159 * 16, 4) << "points on a disc of 4 steps, less 5 % by the bias";
    EXPECT_EQ(q.inLines, 0);
    EXPECT_LT(q.noisy95, 0.02);
    EXPECT_EQ(q.sided, 0) << "an open sheet has no outside";
}

TEST(CloudQuality, TheBorderAndAHoleAreFoundAndNothingElse)
{
    const int          side  = 101;                 // points
    const double       count = double(side) * side; // of the whole lattice
    const CloudQuality whole = cloudQuality(objectOf(lattice(50, 1e-3)));
    EXPECT_NEAR(whole.border * count, 4 * (side - 1), 8) << "the outermost row, to within its corners";
    EXPECT_EQ(whole.borderWidths.size(), 1U);

    const auto         rest  = lattice(50, 1e-3, 12e-3);
    const CloudQuality holed = cloudQuality(objectOf(rest));
    const double       round = 2 * 3.14159 * 12; // its length in steps
    const double       found = holed.border * double(rest.size()) - whole.border * count;
    EXPECT_GT(found, 0.6 * round) << "a lattice's circle has from 0.7 to 1 point per step";
    EXPECT_LT(found, 1.4 * round) << "and its second row is no border";
    ASSERT_EQ(holed.borderWidths.size(), 2U) << "the sheet's own, and the hole's";
    EXPECT_NEAR(holed.borderWidths[0], 100e-3, 1e-9);
    EXPECT_NEAR(holed.borderWidths[1], 24e-3, 3e-3) << "the points around it lie up to a step and a half outside";

    const auto small = lattice(50, 1e-3, 1.1e-3); // five points are missing: the touch bridges that
    EXPECT_NEAR(cloudQuality(objectOf(small)).border * double(small.size()), whole.border * count, 0.5);
}

/// A random sheet that rises by 0.3, 0.5 mm between points, with noise of a camera in its depth.
/// \param step  of the depths that are told apart [m]; 0: all
std::vector<glm::dvec3> depthImage(double step)
{
    std::mt19937_64                        random(3);
    std::uniform_real_distribution<double> along(0, 60e-3);
    std::normal_distribution<double>       noise(0, 0.4e-3);
    std::vector<glm::dvec3>                points;
    for (int n = 0; n < 14'400; ++n) {
        const double x = along(random), y = along(random), z = 0.3 * x + noise(random);
        points.emplace_back(x, y, step > 0 ? step * std::round(z / step) : z);
    }
    return points;
}

TEST(CloudQuality, StepsOfDepthAreNamedAndRegularPointsAreNone)
{
    EXPECT_EQ(cloudQuality(objectOf(depthImage(0))).depthStep, 0);
    EXPECT_NEAR(cloudQuality(objectOf(depthImage(0.8e-3))).depthStep, 0.8e-3, 1e-9) << "24 values of 600 points";
    EXPECT_EQ(cloudQuality(objectOf(lattice(80, 1e-3))).depthStep, 0) << "rows and columns, none of them across";
    std::vector<glm::dvec3> two = lattice(80, 1e-3); // the faces of a thin body
    for (const glm::dvec3& p : lattice(80, 1e-3)) two.push_back(p - glm::dvec3(0, 0, 1e-3));
    EXPECT_EQ(cloudQuality(objectOf(std::move(two))).depthStep, 0) << "two values of depth";
}

TEST(CloudQuality, StraysAreCountedAndChangeNothingElse)
{
    std::vector<glm::dvec3> points = lattice(50, 1e-3);
    const CloudQuality      sheet  = cloudQuality(objectOf(points));
    points.emplace_back(1, 0, 0);
    points.emplace_back(0, 0, 0.5);
    points.push_back(points.front() + glm::dvec3(10e-3, 10e-3, 12e-3));
    const CloudQuality strays = cloudQuality(objectOf(points));
    EXPECT_EQ(sheet.strays, 0U);
    EXPECT_EQ(strays.strays, 3U) << "one that is twelve spacings above the sheet is a stray, too";
    EXPECT_NEAR(strays.spacing.most / sheet.spacing.most, 1, 0.1) << "it was the distance of the furthest";
    EXPECT_NEAR(strays.area / sheet.area, 1, 0.01);
}

TEST(CloudQuality, GaussianNoiseIsMeasured)
{
    for (const double sigma : {0.1e-3, 0.5e-3}) {
        std::mt19937               random(7);
        std::normal_distribution<> noise(0, sigma);
        auto                       points = lattice(60, 1e-3);
        for (glm::dvec3& p : points) p.z += noise(random);
        const CloudQuality q = cloudQuality(objectOf(points));
        EXPECT_NEAR(q.noise, sigma, 0.15 * sigma)
            << "28 points a fit know a standard deviation to 13 %; the median, less";
        EXPECT_NEAR(q.noisy, sigma / q.spacing.typical, 0.15 * sigma / q.spacing.typical);
        EXPECT_GT(q.noise95, q.noise);
        EXPECT_LT(q.noise95, 1.6 * sigma);
        EXPECT_LT(q.border, 0.08) << "the border is 3 % of the points; noise makes no holes";
    }
}

TEST(CloudQuality, AClosedBoxHasNoBorder)
{
    std::vector<glm::dvec3> points;
    constexpr int           kSide = 40;
    for (int i = 0; i <= kSide; ++i)
        for (int j = 0; j <= kSide; ++j)
            for (int k = 0; k <= kSide; ++k)
                if (i % kSide == 0 || j % kSide == 0 || k % kSide == 0)
                    points.emplace_back(i * 1e-3, j * 1e-3, k * 1e-3);
    const CloudQuality q = cloudQuality(objectOf(points));
    EXPECT_LE(q.border * double(points.size()), 8) << "its eight corners at most";
    EXPECT_NEAR(q.area, 6 * 0.04 * 0.04, 6 * 0.04 * 0.04 * 0.1) << "six faces; 5 % by the spacing's bias";
}

TEST(CloudQuality, AStepInDensityIsNoBorderAndIsUneven)
{
    std::vector<glm::dvec3> points; // x < 0: steps of 1 mm; x > 0: of 4 mm; 120 mm x 120 mm each
    for (int i = -120; i < 0; ++i)
        for (int j = -60; j <= 60; ++j) points.emplace_back(i * 1e-3, j * 1e-3, 0);
    for (int i = 0; i <= 30; ++i)
        for (int j = -15; j <= 15; ++j) points.emplace_back(i * 4e-3, j * 4e-3, 0);
    const CloudQuality q = cloudQuality(objectOf(points));
    EXPECT_NEAR(q.spacing.low, 1e-3, 0.05e-3);
    EXPECT_NEAR(q.spacing.high, 4e-3, 0.25e-3);
    EXPECT_NEAR(q.unevenness(), 4, 0.4) << "half of the area has the one spacing, half the other";
    const double outermost = 2 * 120 + 121 + 2 * 30 + 31;
    EXPECT_NEAR(q.border * double(points.size()), outermost, 12) << "and none of the 121 dense points along the step";
}

TEST(CloudQuality, ScanLinesAreToldFromSheets)
{
    std::vector<glm::dvec3> lines, random;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 1000; ++j) lines.emplace_back(i * 2e-3, j * 0.1e-3, 0); // 2 mm apart, a point each 0.1 mm
    std::mt19937                     draw(3);
    std::uniform_real_distribution<> place(0, 0.1);
    for (int i = 0; i < 10000; ++i) random.emplace_back(place(draw), place(draw), 0);
    const CloudQuality q = cloudQuality(objectOf(lines)), sheet = cloudQuality(objectOf(random));
    EXPECT_TRUE(q.areLines());
    EXPECT_NEAR(q.alongLine, 0.1e-3, 1e-9);
    EXPECT_NEAR(q.betweenLines, 2e-3, 1e-8) << "exact but for the rounding of floats";
    EXPECT_FALSE(sheet.areLines());
    EXPECT_LT(sheet.inLines, 0.08) << "9 % times 40 % by chance";
    EXPECT_LT(sheet.border, 0.06) << "the border of 10 000 points is 4 % of them";
    EXPECT_EQ(cloudQuality(objectOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})).spacing.typical, 0) << "no surface";
}

} // namespace
} // namespace palp
