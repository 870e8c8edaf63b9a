#include "engine/cloud/point_cloud.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kNan      = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PointCloud two(const glm::dvec3& second, double stiffness)
{
    return PointCloud({{1, 2, 3}, second}, {10, stiffness}, StiffnessKind::modulus);
}

TEST(PointCloud, KeepsWhatItIsGivenInOrder)
{
    const PointCloud cloud({{1, 2, 3}, {-4, 5, 0}}, {10, 20}, StiffnessKind::rigidity);

    EXPECT_EQ(cloud.size(), 2u);
    EXPECT_EQ(cloud.positions()[1], glm::dvec3(-4, 5, 0));
    EXPECT_EQ(cloud.stiffness()[1], 20);
    EXPECT_EQ(cloud.kind(), StiffnessKind::rigidity);
}

TEST(PointCloud, OtherStiffnessesShareThePoints)
{
    const PointCloud cloud({{1, 2, 3}, {-4, 5, 0}}, {10, 20}, StiffnessKind::rigidity);
    const PointCloud other(cloud, {30, 40});

    EXPECT_EQ(other.positions().data(), cloud.positions().data());
    EXPECT_EQ(other.stiffness()[1], 40);
    EXPECT_EQ(cloud.stiffness()[1], 20);
    EXPECT_EQ(other.kind(), StiffnessKind::rigidity);
    EXPECT_EQ(other.bounds().low, cloud.bounds().low);
    EXPECT_EQ(other.size(), 2U);
    EXPECT_THROW(PointCloud(cloud, {30, kNan}), Error);
    EXPECT_THROW(PointCloud(cloud, {30}), ContractViolation);
}

TEST(PointCloud, BoundsEncloseEveryPointTightly)
{
    const PointCloud cloud({{1, 2, 3}, {-4, 5, 0}, {0, 0, 7}}, {1, 1, 1}, StiffnessKind::modulus);

    EXPECT_EQ(cloud.bounds().low, glm::dvec3(-4, 0, 0));
    EXPECT_EQ(cloud.bounds().high, glm::dvec3(1, 5, 7));
    EXPECT_EQ(cloud.bounds().centre(), glm::dvec3(-1.5, 2.5, 3.5));
    EXPECT_DOUBLE_EQ(cloud.bounds().diagonal(), std::sqrt(25.0 + 25.0 + 49.0));
}

TEST(PointCloud, AnEmptyCloudIsRefused)
{
    EXPECT_THROW(PointCloud({}, {}, StiffnessKind::modulus), Error);
}

TEST(PointCloud, ADifferentNumberOfStiffnessesIsAMistakeOfTheCaller)
{
    EXPECT_THROW(PointCloud({{1, 2, 3}}, {1, 2}, StiffnessKind::modulus), ContractViolation);
}

TEST(PointCloud, PositionsThatAreNotFiniteAreRefusedByIndex)
{
    for (const double bad : {kNan, kInfinity, -kInfinity})
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 position{4, 5, 6};
            position[k] = bad;
            try {
                two(position, 1);
                FAIL() << "accepted " << bad;
            } catch (const Error& error) {
                EXPECT_NE(std::string(error.what()).find("point 1"), std::string::npos) << error.what();
            }
        }
}

TEST(PointCloud, StiffnessMustBeFiniteAndAboveZero)
{
    for (const double bad : {kNan, kInfinity, 0.0, -0.0, -1.0}) {
        try {
            two({4, 5, 6}, bad);
            FAIL() << "accepted " << bad;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("point 1"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("Pa"), std::string::npos) << error.what();
        }
    }
    EXPECT_NO_THROW(two({4, 5, 6}, std::numeric_limits<double>::denorm_min()));
}

TEST(PointCloud, ModulusAndRigidityAreTwoViewsOfTheSameSheet)
{
    const Material   material{.thickness = 2e-3, .poissonRatio = 0.3};
    const PointCloud soft({{0, 0, 0}}, {1e6}, StiffnessKind::modulus);
    const PointCloud plate({{0, 0, 0}}, {soft.rigidity(0, material)}, StiffnessKind::rigidity);

    EXPECT_EQ(soft.modulus(0, material), 1e6);
    EXPECT_DOUBLE_EQ(soft.rigidity(0, material), 1e6 * 8e-9 / (12 * 0.91)) << "E h^3 / (12 (1 - nu^2)) by hand";
    EXPECT_EQ(plate.rigidity(0, material), soft.rigidity(0, material));
    EXPECT_DOUBLE_EQ(plate.modulus(0, material), 1e6);
}

TEST(PointCloud, UnitsAreThoseOfFiles)
{
    EXPECT_STREQ(unitOf(StiffnessKind::modulus), "Pa");
    EXPECT_STREQ(unitOf(StiffnessKind::rigidity), "N_m");
    EXPECT_STREQ(unitOf(StiffnessKind::felt), "N/m");
}

TEST(PointCloud, WhatWasFeltIsNeitherModulusNorRigidity)
{
    const PointCloud map({{0, 0, 0}}, {400}, StiffnessKind::felt);

    EXPECT_TRUE(std::isnan(map.modulus(0, {})));
    EXPECT_TRUE(std::isnan(map.rigidity(0, {})));
}

} // namespace
} // namespace palp
