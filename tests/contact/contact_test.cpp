#include "engine/contact/contact.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

struct Object : SoftObject {
    explicit Object(const char* sample) : SoftObject(makeSample(sampleNamed(sample), 5000, 1)) {}

    [[nodiscard]] Contact touch(const glm::dvec3& place, const std::optional<glm::dvec3>& from = {}) const
    {
        return touchAt(*this, place, from, 5e-3);
    }
};

TEST(Contact, IsTheFootOfThePlaceWhereverThePointsLie)
{
    const Object ellipsoid("ellipsoid");
    // Points are 2.4 mm apart, and the surface bends by 0.1 mm over one and a half of that.
    for (const glm::dvec3 direction : {glm::dvec3(0, 0, 1), glm::dvec3(1, 2, 3), glm::dvec3(-3, 1, 0.2)}) {
        const glm::dvec3 axes(60e-3, 45e-3, 35e-3);
        const glm::dvec3 foot   = direction / glm::length(direction / axes);
        const glm::dvec3 normal = glm::normalize(foot / (axes * axes));
        EXPECT_LT(glm::length(ellipsoid.touch(foot).point - foot), 0.15e-3);
        EXPECT_LT(glm::length(ellipsoid.touch(foot + 4e-3 * normal).point - foot), 0.3e-3)
            << "4 mm over it, where a normal that is off by two degrees counts";
    }
}

TEST(Contact, BeyondTheRimOfASheetIsItsNearestPoint)
{
    const Object sheet("sheet");
    const double side = sheet.cloud().bounds().high.x;
    const auto   at   = sheet.touch({side + 4e-3, 0, 0}).point;
    EXPECT_LE(at.x, side);
}

TEST(Contact, OutwardIsAwayFromAClosedObjectOnEverySide)
{
    const Object ellipsoid("ellipsoid");
    for (const glm::dvec3& p : ellipsoid.positions()) {
        const glm::dvec3 normal =
            glm::normalize(p / (glm::dvec3(60e-3, 45e-3, 35e-3) * glm::dvec3(60e-3, 45e-3, 35e-3)));
        EXPECT_GT(glm::dot(ellipsoid.touch(p).outward, normal), 0.99) << "the bounds of 5000 points are 1 % short";
    }
}

TEST(Contact, BothSidesOfAThinObjectHaveTheirOwnOutward)
{
    const Object lobe("ear-lobe");
    EXPECT_GT(lobe.touch({0, 0, 1.5e-3}).outward.z, 0.9);
    EXPECT_LT(lobe.touch({0, 0, -1.5e-3}).outward.z, -0.9);
}

TEST(Contact, AFlatSheetIsTouchedFromAbove)
{
    EXPECT_EQ(Object("sheet").touch({70e-3, 70e-3, 0}).outward, glm::dvec3(0, 0, 1));
}

TEST(Contact, AFlatWallIsTouchedAcrossWhicheverWayItStands)
{
    for (int across = 0; across < 3; ++across) {
        std::vector<glm::dvec3> wall;
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; j <= 40; ++j) {
                glm::dvec3 p(0);
                p[(across + 1) % 3] = 1e-3 * i;
                p[(across + 2) % 3] = 1e-3 * j;
                wall.push_back(p);
            }
        const std::vector<double> stiffness(wall.size(), 1e6);
        const SoftObject          object(PointCloud(wall, stiffness, StiffnessKind::modulus));
        glm::dvec3                expected(0);
        expected[across] = 1;
        EXPECT_EQ(touchAt(object, wall[45], {}, 5e-3).outward, expected) << "axis " << across;
    }
}

TEST(Contact, AnObjectOfManyMetresIsTouchedFromOutsideToo)
{
    std::vector<glm::dvec3> ball;
    for (int n = 0; n < 2000; ++n) { // Fibonacci's spiral
        const double z = 1 - (2 * n + 1) / 2000.0, turn = 2.39996322972865 * n, r = std::sqrt(1 - z * z);
        ball.push_back(20.0 * glm::dvec3(r * std::cos(turn), r * std::sin(turn), z));
    }
    const std::vector<double> stiffness(ball.size(), 1e6);
    const SoftObject          object(PointCloud(ball, stiffness, StiffnessKind::modulus));
    for (const glm::dvec3& p : ball) ASSERT_GT(glm::dot(touchAt(object, p, {}, 5e-3).outward, glm::normalize(p)), 0.99);
}

TEST(Contact, InTheMiddleOfAnObjectUpIsOutward)
{
    std::vector<glm::dvec3> points{{0, 0, 0}};
    for (const double x : {-1e-2, 1e-2})
        for (const double y : {-1e-2, 1e-2})
            for (const double z : {-1e-2, 1e-2}) points.push_back({x, y, z});
    const std::vector<double> stiffness(points.size(), 1e6);
    const SoftObject          object(PointCloud(points, stiffness, StiffnessKind::modulus));
    EXPECT_EQ(touchAt(object, {0, 0, 0}, {}, 5e-3).outward, glm::dvec3(0, 0, 1));
}

TEST(Contact, TheUserDecidesTheSide)
{
    const glm::dvec3 outward = Object("sheet").touch({0, 0, 0}, glm::dvec3(0, 3, -4)).outward;
    EXPECT_DOUBLE_EQ(outward.y, 0.6);
    EXPECT_DOUBLE_EQ(outward.z, -0.8);
}

TEST(Contact, PlacesFarAwayAndDirectionsThatAreNoneAreRefused)
{
    const Object sheet("sheet");
    EXPECT_THROW((void)sheet.touch({0, 0, 6e-3}), Error) << "farther than the reach of 5 mm";
    EXPECT_NO_THROW((void)sheet.touch({0, 0, 4e-3})) << "the nearest of 5000 points is within 3 mm sideways";
    EXPECT_THROW((void)sheet.touch({0, 0, 0}, glm::dvec3(0, 0, 0)), Error);
}

} // namespace
} // namespace palp
