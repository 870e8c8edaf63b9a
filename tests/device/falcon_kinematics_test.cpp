#include "device/falcon/falcon_kinematics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

using Legs = std::array<double, 3>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

const FalconKinematics kFalcon;

/// Even in -1 to 1, the same on every machine.
double even(std::mt19937_64& random)
{
    return double(random() >> 11) * 0x1p-52 - 1;
}

/// In the ball of 40 mm about the middle, in which the device is used.
glm::dvec3 inWorkSphere(std::mt19937_64& random)
{
    while (true) {
        const glm::dvec3 p(even(random), even(random), even(random));
        if (glm::dot(p, p) <= 1) return FalconKinematics::kMiddle + 0.04 * p;
    }
}

/// Positions, with angles and counts that were computed elsewhere from the closure of the legs, to all digits given.
struct Vector {
    glm::dvec3 millimetres;
    Legs       angles; ///< [rad]
    Legs       counts;
};
const Vector kVectors[] = {
    {{0, 0, 75}, {-0.319735194, -0.319735194, -0.319735194}, {-1463.4274, -1463.4274, -1463.4274}},
    {{0, 0, 100}, {0.139767295, 0.139767295, 0.139767295}, {-740.8310, -740.8310, -740.8310}},
    {{0, 0, 125}, {0.483618371, 0.483618371, 0.483618371}, {-200.1037, -200.1037, -200.1037}},
    {{0, 0, 150}, {0.824550668, 0.824550668, 0.824550668}, {336.0337, 336.0337, 336.0337}},
    {{0, 0, 170}, {1.165114463, 1.165114463, 1.165114463}, {871.5916, 871.5916, 871.5916}},
    {{20, 0, 110}, {0.387430715, 0.066383488, 0.477562507}, {-351.3648, -856.2316, -209.6269}},
    {{-20, 0, 110}, {0.247491152, 0.538920655, 0.142724992}, {-571.4285, -113.1374, -736.1798}},
    {{0, 20, 110}, {0.070032487, 0.374177052, 0.487055584}, {-850.4933, -372.2070, -194.6984}},
    {{0, -30, 125}, {0.827717524, 0.483781622, 0.309732935}, {341.0138, -199.8469, -473.5494}},
    {{30, -30, 100}, {0.735818727, -0.214686871, 0.302518912}, {196.4972, -1298.2323, -484.8939}},
    {{-30, 20, 120}, {0.194615426, 0.847786898, 0.461283498}, {-654.5789, 372.5741, -235.2266}},
    {{25, 25, 145}, {0.690964177, 0.670581593, 1.137068720}, {125.9606, 93.9077, 827.4879}},
};

TEST(FalconKinematics, AnglesAreThoseComputedFromTheClosure)
{
    for (const Vector& v : kVectors) {
        const auto angles = kFalcon.angles(v.millimetres * 1e-3);
        ASSERT_TRUE(angles);
        const Legs counts = kFalcon.counts(*angles);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR((*angles)[i], v.angles[i], 0.6e-9) << "half the last digit given";
            EXPECT_NEAR(counts[i], v.counts[i], 0.6e-4) << "half the last digit given";
        }
    }
}

TEST(FalconKinematics, EncodersGiveThePositionsComputedFromTheClosure)
{
    const std::pair<std::array<std::int16_t, 3>, glm::dvec3> vectors[] = {
        {{0, 0, 0}, {0, 0, 134.602428}},
        {{-500, -500, -500}, {0, 0, 110.754499}},
        {{-300, 100, -500}, {-20.890548, -1.445648, 121.281521}},
        {{400, -250, 50}, {16.185941, -18.258443, 134.983910}},
        {{250, -700, -300}, {19.827311, -25.162040, 117.559930}},
        {{-1394, -1534, -1458}, {1.787083, -1.545786, 75.011662}}, // captured with the grip pushed in
    };
    for (const auto& [counts, millimetres] : vectors) {
        const auto position = kFalcon.position(kFalcon.angles(counts));
        ASSERT_TRUE(position);
        EXPECT_LE(glm::distance(*position * 1e3, millimetres), 1e-6) << "the digits given, in mm";
    }
}

TEST(FalconKinematics, TorquesAreThoseComputedFromTheClosure)
{
    struct Case {
        glm::dvec3 millimetres, force;
        Legs       torques;
    };
    const Case cases[] = {
        {{0, 0, 125}, {0, 0, 1}, {0.025242713, 0.025242713, 0.025242713}},
        {{0, 0, 125}, {1, 0, 0}, {0.017889549, -0.060599508, 0.042709959}},
        {{0, 0, 125}, {0, 1, 0}, {-0.059645749, 0.014330070, 0.045315679}},
        {{20, 0, 110}, {1, 2, -3}, {-0.154732707, -0.123916742, 0.082070251}},
        {{-30, 20, 120}, {-2, 0.5, 1.5}, {0.009494795, 0.155667348, -0.015866383}},
    };
    for (const Case& c : cases) {
        const auto torques = kFalcon.torques(c.millimetres * 1e-3, c.force);
        ASSERT_TRUE(torques);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR((*torques)[i], c.torques[i], 0.6e-9) << "half the last digit given";
        EXPECT_LE(glm::distance(*kFalcon.force(c.millimetres * 1e-3, *torques), c.force), 1e-13) << "rounding";
    }
}

TEST(FalconKinematics, ACountIsTheAngleThatGearAndEncoderMake)
{
    EXPECT_NEAR(1 / FalconGeometry{}.countsPerRadian(), 6.359048e-4, 0.6e-10) << "half the last digit published";
    EXPECT_DOUBLE_EQ(kFalcon.angles(std::array<std::int16_t, 3>{})[0], 0.610865238198015) << "35 degrees";
}

TEST(FalconKinematics, TheJacobianIsTheSlopeOfTheAngles)
{
    constexpr double kStep = 1e-6; // m: the error of the difference is of order step^2 and rounding over step
    std::mt19937_64  random(1);
    for (int n = 0; n < 20'000; ++n) {
        const glm::dvec3 p    = inWorkSphere(random);
        const auto       rows = kFalcon.jacobian(p);
        ASSERT_TRUE(rows);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step{};
            step[axis]        = kStep;
            const Legs ahead  = *kFalcon.angles(p + step);
            const Legs behind = *kFalcon.angles(p - step);
            for (std::size_t i = 0; i < 3; ++i)
                ASSERT_NEAR((*rows)[i][axis], (ahead[i] - behind[i]) / (2 * kStep), 1e-6)
                    << "rad/m of up to 26: rounding of the angles, 1e-16 * 10 over 2e-6, and step^2 of the third slope";
        }
    }
}

TEST(FalconKinematics, PositionsComeBackFromTheirAnglesAfterAColdStart)
{
    std::mt19937_64 random(2);
    double          worst = 0; // m
    for (int n = 0; n < 100'000; ++n) {
        const glm::dvec3 p    = inWorkSphere(random);
        const auto       back = kFalcon.position(*kFalcon.angles(p));
        ASSERT_TRUE(back) << p.x << " " << p.y << " " << p.z;
        worst = std::max(worst, glm::distance(p, *back));
    }
    EXPECT_LE(worst, 1e-9) << "Newton's method stops at 1e-9 rad, worth 0.1 nm";
}

TEST(FalconKinematics, PositionsComeBackFromTheWholeCubeToo)
{
    std::mt19937_64 random(3);
    int             reached = 0;
    for (int n = 0; n < 100'000; ++n) {
        const glm::dvec3 p    = FalconKinematics::kMiddle + 0.04 * glm::dvec3(even(random), even(random), even(random));
        const auto       legs = kFalcon.angles(p);
        if (!legs) continue;
        ++reached;
        const auto back = kFalcon.position(*legs);
        ASSERT_TRUE(back) << p.x << " " << p.y << " " << p.z;
        ASSERT_LE(glm::distance(p, *back), 1e-9) << "as above";
    }
    EXPECT_GE(reached, 99'900) << "all but the tips of its corners";
}

TEST(FalconKinematics, PositionsComeBackFromAnyStartInTheCube)
{
    std::mt19937_64 random(6);
    int             reached = 0, lost = 0;
    for (int n = 0; n < 200'000; ++n) {
        const glm::dvec3 p = FalconKinematics::kMiddle + 0.04 * glm::dvec3(even(random), even(random), even(random));
        const glm::dvec3 start =
            FalconKinematics::kMiddle + 0.04 * glm::dvec3(even(random), even(random), even(random));
        if (!kFalcon.jacobian(p)) continue; // so near to a singularity two positions have nearly the same angles
        ++reached;
        const auto back = kFalcon.position(*kFalcon.angles(p), start);
        ASSERT_LE(glm::distance(p, back.value_or(p)), 1e-9) << "as above";
        lost += !back;
    }
    EXPECT_GE(reached, 199'800) << "all but the tips of its corners";
    EXPECT_LE(lost, 1) << "from corner to corner; 1 in a million, and one in 6000 without a limit on the step";
}

TEST(FalconKinematics, WholeCountsKeepThePositionWithin80Micrometres)
{
    std::mt19937_64 random(4);
    double          worst = 0; // m
    for (int n = 0; n < 100'000; ++n) {
        const glm::dvec3            p      = inWorkSphere(random);
        const Legs                  counts = kFalcon.counts(*kFalcon.angles(p));
        std::array<std::int16_t, 3> encoders{};
        for (std::size_t i = 0; i < 3; ++i) encoders[i] = std::int16_t(std::lround(counts[i]));
        const auto back = kFalcon.position(kFalcon.angles(encoders), p);
        ASSERT_TRUE(back);
        worst = std::max(worst, glm::distance(p, *back));
    }
    EXPECT_LE(worst, 80e-6) << "half a count, 0.32 mrad, on levers of up to 0.1 m, of three legs at once";
    EXPECT_GE(worst, 20e-6) << "there must be some rounding";
}

TEST(FalconKinematics, AnyStartLeadsToThePosition)
{
    const Legs       angles   = *kFalcon.angles(glm::dvec3(0.02, -0.01, 0.11));
    const glm::dvec3 starts[] = {{0, 0, 0.15}, {0.02, -0.01, 0.1100001}, {5, 5, 5}, {kNan, 0, 0}, {0, kInf, 0}};
    for (const glm::dvec3& start : starts) {
        const auto p = kFalcon.position(angles, start);
        ASSERT_TRUE(p);
        EXPECT_LE(glm::distance(*p, glm::dvec3(0.02, -0.01, 0.11)), 1e-9) << "as above";
    }
}

TEST(FalconKinematics, WhatNoArmCanDoIsSaidSo)
{
    EXPECT_FALSE(kFalcon.angles(glm::dvec3(0, 0, 1)));
    EXPECT_FALSE(kFalcon.angles(glm::dvec3(0.2, 0, 0.125)));
    for (double bad : {kNan, kInf, -kInf, 1e300})
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 v = FalconKinematics::kMiddle;
            v[axis]      = bad;
            EXPECT_FALSE(kFalcon.angles(v));
            EXPECT_FALSE(kFalcon.jacobian(v));
            EXPECT_FALSE(kFalcon.torques(v, {0, 0, 1}));
            EXPECT_FALSE(kFalcon.force(v, {1, 1, 1}));
            EXPECT_EQ(kFalcon.torques(FalconKinematics::kMiddle, v).has_value(), bad == 1e300);

            Legs angles{0.4, 0.4, 0.4};
            angles[std::size_t(axis)] = bad;
            EXPECT_FALSE(kFalcon.position(angles));
        }
    EXPECT_FALSE(kFalcon.position(Legs{3, 3, 3})) << "thighs past the shins' reach";
    EXPECT_FALSE(kFalcon.position(kFalcon.angles(std::array<std::int16_t, 3>{32767, -32768, 0})));
}

/// 1 for three legs at right angles to each other and each at right angles to its thigh: see kLeastLever.
std::pair<double, double> regularityOf(const std::array<glm::dvec3, 3>& rows)
{
    double lever = 1, scale = 1;
    for (const glm::dvec3& row : rows) {
        lever = std::min(lever, 1 / (FalconGeometry{}.thigh * glm::length(row)));
        scale *= glm::length(row);
    }
    return {lever, std::abs(glm::dot(rows[0], glm::cross(rows[1], rows[2]))) / scale};
}

TEST(FalconKinematics, ForcesAreRefusedNearSingularitiesAndNeverInTheWorkSphere)
{
    std::mt19937_64 random(5);
    for (int n = 0; n < 20'000; ++n) {
        const auto rows = kFalcon.jacobian(inWorkSphere(random));
        ASSERT_TRUE(rows);
        const auto [lever, volume] = regularityOf(*rows);
        ASSERT_GE(lever, 0.4);
        ASSERT_GE(volume, 0.4);
    }

    // Outwards from the middle until out of reach. What is not refused on the way is far from both singularities, so
    // that torques stay in proportion; and something is refused before the end, where a leg is stretched.
    int refused = 0;
    for (int n = 0; n < 1'000; ++n) {
        const glm::dvec3 way = glm::normalize(glm::dvec3(even(random), even(random), even(random)));
        for (double r = 0; r < 0.2; r += 0.2e-3) {
            const glm::dvec3 p = FalconKinematics::kMiddle + r * way;
            if (!kFalcon.angles(p)) break;
            const auto torques = kFalcon.torques(p, way);
            if (!torques) {
                ++refused;
                continue;
            }
            const auto [lever, volume] = regularityOf(*kFalcon.jacobian(p));
            ASSERT_GE(lever, 0.149) << "kLeastLever, and rounding";
            ASSERT_GE(volume, 0.149) << "kLeastVolume, and rounding";
            for (double torque : *torques)
                ASSERT_LE(std::abs(torque), 0.4) << "N m of 1 N: the thigh, 60 mm, over a volume of 0.15";
        }
    }
    EXPECT_GT(refused, 1'000);
}

TEST(FalconKinematics, ALongerShinPutsTheGripFurtherOut)
{
    FalconGeometry longer;
    longer.shin = 110e-3;
    EXPECT_GT(FalconKinematics(longer).position({0.4, 0.4, 0.4})->z, kFalcon.position({0.4, 0.4, 0.4})->z + 5e-3);
}

TEST(FalconKinematics, AGeometryThatCannotBeIsRefusedByName)
{
    for (double bad : {0.0, -1.0, kNan, kInf}) {
        FalconGeometry geometry;
        geometry.thigh = bad;
        try {
            const FalconKinematics kinematics(geometry);
            FAIL() << bad;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("thigh"), std::string::npos) << error.what();
        }
    }
}

} // namespace
} // namespace palp
