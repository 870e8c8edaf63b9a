#include "device/falcon/falcon_motors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

const FalconKinematics kFalcon;
const FalconMotors     kMotors;

double even(std::mt19937_64& random)
{
    return double(random() >> 11) * 0x1p-52 - 1;
}

glm::dvec3 inCube(std::mt19937_64& random) // of 80 mm
{
    return FalconKinematics::kMiddle + 0.04 * glm::dvec3(even(random), even(random), even(random));
}

glm::dvec3 direction(std::mt19937_64& random)
{
    while (true) {
        const glm::dvec3 v(even(random), even(random), even(random));
        if (const double r = glm::length(v); r > 0.1 && r < 1) return v / r;
    }
}

/// [N] on the hand of motors that were told this.
glm::dvec3 delivered(const glm::dvec3& position, const FalconDrive& drive)
{
    return kFalcon.force(position, kMotors.torques(drive.motors)).value_or(glm::dvec3(0));
}

/// [degrees] between two vectors, good for small angles too.
double degreesBetween(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / std::numbers::pi;
}

TEST(FalconMotors, PushTheHandWhereTheForceSays)
{
    // Rounding shifts each motor by half a count at most, and its force by that over G along its row of the Jacobian:
    // up to 60 rad/m three times in this cube, 21 mN in all. Half a degree of 2.5 N is 22 mN.
    std::mt19937_64 random(1);
    int             tried = 0;
    for (int n = 0; n < 100'000; ++n) {
        const glm::dvec3  p     = inCube(random);
        const glm::dvec3  force = direction(random) * (2.5 + 2.5 * (1 + even(random)));
        const FalconDrive drive = kMotors.drive(p, force);
        if (drive.singular) continue;
        ++tried;

        ASSERT_EQ(drive.scale, 1) << "all motors together hold 9 N everywhere in the cube";
        ASSERT_LE(degreesBetween(delivered(p, drive), force), 0.5);
        ASSERT_LE(glm::distance(delivered(p, drive), force), 22e-3) << "N, rounding as above";
    }
    EXPECT_GE(tried, 99'900) << "the corners of the cube come near to a singularity, 2 places in 10 000";
}

TEST(FalconMotors, PushExactlyButForRoundingInTheWorkSphere)
{
    std::mt19937_64 random(2);
    for (int n = 0; n < 50'000; ++n) {
        const glm::dvec3 offset = 0.04 * direction(random) * std::abs(even(random));
        const glm::dvec3 p = FalconKinematics::kMiddle + offset, force = 6.0 * even(random) * direction(random);

        const FalconDrive drive = kMotors.drive(p, force);

        ASSERT_FALSE(drive.singular);
        ASSERT_LE(glm::distance(delivered(p, drive), force), 10e-3)
            << "N: half a count of 4200 a N m, along rows of up to 26 rad/m, three times";
    }
}

TEST(FalconMotors, SaturateInTheSameDirection)
{
    std::mt19937_64 random(3);
    for (int n = 0; n < 50'000; ++n) {
        const glm::dvec3  p = inCube(random), force = direction(random) * std::exp(5 + 60 * (1 + even(random)));
        const FalconDrive drive = kMotors.drive(p, force);
        if (drive.singular) continue;

        int most = 0;
        for (const int motor : drive.motors) most = std::max(most, std::abs(motor));
        ASSERT_EQ(most, FalconMotors::kMost);
        ASSERT_LT(drive.scale, 1);
        ASSERT_LE(degreesBetween(delivered(p, drive), force), 0.5) << "as above: at saturation it is 9 N at least";
        ASSERT_NEAR(glm::length(delivered(p, drive)) / (drive.scale * glm::length(force)), 1, 3e-3)
            << "21 mN of 9 N or more, rounding as above";
    }
}

TEST(FalconMotors, PullTowardsTheUserByNegativeNumbers)
{
    // tau = 0.025242713 N m each for 1 N along z in the middle, times 4200.
    EXPECT_EQ(kMotors.drive(FalconKinematics::kMiddle, {0, 0, 1}).motors,
              (std::array<std::int16_t, 3>{-106, -106, -106}));
    EXPECT_EQ(kMotors.drive(FalconKinematics::kMiddle, {0, 0, -1}).motors,
              (std::array<std::int16_t, 3>{106, 106, 106}));
    EXPECT_EQ(kMotors.drive(FalconKinematics::kMiddle, {}).motors, (std::array<std::int16_t, 3>{}));
}

TEST(FalconMotors, RenderNoForceThatIsNoNumber)
{
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
    for (double bad : {kNan, kInf, -kInf})
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 force(1);
            force[axis]             = bad;
            const FalconDrive drive = kMotors.drive(FalconKinematics::kMiddle, force);
            EXPECT_TRUE(drive.badForce);
            EXPECT_EQ(drive.motors, (std::array<std::int16_t, 3>{}));
            EXPECT_EQ(drive.scale, 0);
        }

    // Finite, but no torque of it is.
    const double      most  = std::numeric_limits<double>::max();
    const FalconDrive drive = kMotors.drive(FalconKinematics::kMiddle, {most, -most, most});
    EXPECT_TRUE(drive.badForce);
    EXPECT_EQ(drive.motors, (std::array<std::int16_t, 3>{}));
}

TEST(FalconMotors, RenderNoForceWhereTheArmCannotBe)
{
    const FalconDrive drive = kMotors.drive({0, 0, 0.5}, {0, 0, 1});
    EXPECT_TRUE(drive.singular);
    EXPECT_EQ(drive.motors, (std::array<std::int16_t, 3>{}));
}

TEST(FalconMotors, AScaleThatCannotBeIsRefused)
{
    for (double bad : {0.0, -4200.0, 1999.0, 10'001.0, 1e6, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(FalconMotors(kFalcon, bad), Error) << bad;
    EXPECT_EQ(FalconMotors(kFalcon, 10'000).drive(FalconKinematics::kMiddle, {0, 0, 1}).motors[0], -252);
}

} // namespace
} // namespace palp
