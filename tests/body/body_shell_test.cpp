#include "engine/body/body_shell.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double   kModulus = 1e5; // [Pa]
constexpr Material kSheet{.thickness = 1e-3, .poissonRatio = 0.3};

SoftObject objectOf(std::vector<glm::dvec3> points, const Material& material)
{
    std::vector<double> moduli(points.size(), kModulus);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), material);
}

template <class Holds>
SoftObject heldWhere(const SoftObject& object, const Holds& holds)
{
    std::vector<double> held;
    for (const glm::dvec3& p : object.positions()) held.push_back(holds(p) ? 1 : 0);
    return object.withHeld(std::move(held));
}

std::vector<glm::dvec3> disc(double radius, double spacing)
{
    std::mt19937                     random(1);
    std::uniform_real_distribution<> off(-0.25, 0.25);
    std::vector<glm::dvec3>          points;
    for (double x = -radius; x <= radius; x += spacing)
        for (double y = -radius; y <= radius; y += spacing) {
            const glm::dvec3 p(x + off(random) * spacing, y + off(random) * spacing, 0);
            if (glm::length(p) < radius) points.push_back(p);
        }
    return points;
}

/// A tube about z, its ends at 0 and at its length.
std::vector<glm::dvec3> tube(double radius, double length, double spacing)
{
    std::mt19937                     random(2);
    std::uniform_real_distribution<> off(-0.25, 0.25);
    std::vector<glm::dvec3>          points;
    const int                        around = int(std::lround(2 * std::numbers::pi * radius / spacing));
    for (double z = spacing / 2; z < length; z += spacing)
        for (int k = 0; k < around; ++k) {
            const double angle = 2 * std::numbers::pi * (k + off(random)) / around;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z + off(random) * spacing);
        }
    return points;
}

TEST(BodyShell, AClampedDiscGivesWayAsKirchhoffSays)
{
    constexpr double kRadius = 30e-3;
    const SoftObject plate =
        heldWhere(objectOf(disc(36e-3, 1e-3), kSheet), [](const glm::dvec3& p) { return glm::length(p) > kRadius; });
    const BodyShell body(plate, 1500);
    const auto      moves = body.under({0, 0, 0}, {0, 0, 1}, 4e-3);
    ASSERT_TRUE(moves);
    // w(r) = P / (16 pi D) (a^2 - r^2 - 2 r^2 ln(a / r)), Timoshenko and Woinowsky-Krieger 1959, art. 19.
    const double D = kSheet.rigidity(kModulus);
    for (std::size_t node = 0; node < body.mesh().nodes.size(); ++node) {
        const double r = glm::length(body.mesh().nodes[node].place);
        if (r < 10e-3 || r > 22e-3) continue; // away from the force, which is spread, and from where it is held
        const double w = (kRadius * kRadius - r * r - 2 * r * r * std::log(kRadius / r)) / (16 * std::numbers::pi * D);
        EXPECT_NEAR(-moves->moved[node].z / w, 1, 0.06) << r; // the rim lies to a fourth of a spacing: 2 % of a radius
    }
}

TEST(BodyShell, ATubeBendsAsABeam)
{
    constexpr double kRadius = 10e-3, kLength = 120e-3, kHeld = 10e-3, kAt = 100e-3;
    const SoftObject object =
        heldWhere(objectOf(tube(kRadius, kLength, 1e-3), kSheet), [](const glm::dvec3& p) { return p.z < kHeld; });
    const BodyShell body(object);
    const auto      moves = body.under({kRadius, 0, kAt}, {1, 0, 0}, 4e-3);
    ASSERT_TRUE(moves);
    // The side that is not pressed moves as the axis does; Timoshenko's beam with a shear area of half the tube's.
    const double I    = std::numbers::pi * std::pow(kRadius, 3) * kSheet.thickness,
                 area = 2 * std::numbers::pi * kRadius * kSheet.thickness;
    const double G    = kModulus / (2 * (1 + kSheet.poissonRatio));
    double       sum = 0, expected = 0;
    for (std::size_t node = 0; node < body.mesh().nodes.size(); ++node) {
        const glm::dvec3 p = body.mesh().nodes[node].place;
        if (p.z < 40e-3 || p.z > 70e-3 || p.x > 0) continue;
        const double z = p.z - kHeld, l = kAt - kHeld;
        sum -= moves->moved[node].x;
        expected += z * z * (3 * l - z) / (6 * kModulus * I) + z / (G * area / 2);
    }
    EXPECT_NEAR(sum / expected, 1, 0.04) << "far from the force a tube keeps its circle nearly, 4 % by finer meshes";
}

TEST(BodyShell, MovesAlikeHoweverFineItIsFarFromTheForce)
{
    const SoftObject object =
        heldWhere(objectOf(tube(20e-3, 80e-3, 1e-3), kSheet), [](const glm::dvec3& p) { return p.z < 5e-3; });
    const auto far = [&](std::size_t nodes) {
        const BodyShell body(object, nodes);
        const auto      moves = body.under({20e-3, 0, 50e-3}, {1, 0, 0}, 4e-3);
        double          sum = 0, count = 0;
        for (std::size_t node = 0; node < body.mesh().nodes.size(); ++node) {
            const glm::dvec3 p = body.mesh().nodes[node].place;
            if (p.x > -15e-3 || std::abs(p.z - 50e-3) > 10e-3) continue; // the side that is away from the force
            sum -= moves->moved[node].x;
            ++count;
        }
        return sum / count;
    };
    const double coarse = far(1000), fine = far(4000);
    EXPECT_NEAR(coarse / fine, 1, 0.03) << "a spacing of 2.9 mm for 1.5, on a radius of 20 mm";
}

TEST(BodyShell, ATurnOfTheObjectTurnsItsMoves)
{
    const auto       points = tube(20e-3, 60e-3, 1.5e-3);
    const glm::dvec3 axis   = glm::normalize(glm::dvec3(1, 2, -1));
    const auto       turned = [&](const glm::dvec3& p) { // by a right angle and a half about the axis
        const double angle = 2.3;
        return p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) +
               axis * glm::dot(axis, p) * (1 - std::cos(angle));
    };
    std::vector<glm::dvec3> others;
    std::vector<double>     held;
    for (const glm::dvec3& p : points) {
        others.push_back(turned(p));
        held.push_back(p.z < 5e-3);
    }
    const auto give = [&](const std::vector<glm::dvec3>& of, const glm::dvec3& at, const glm::dvec3& outward) {
        return BodyShell(objectOf(of, kSheet).withHeld(held)).under(at, outward, 4e-3)->give;
    };
    const double one   = give(points, {20e-3, 0, 30e-3}, {1, 0, 0});
    const double other = give(others, turned({20e-3, 0, 30e-3}), turned({1, 0, 0}));
    EXPECT_NEAR(other / one, 1, 0.06) << "other points become nodes, since their order in space is another";
}

TEST(BodyShell, SaysWhereNothingHolds)
{
    const SoftObject free = objectOf(disc(20e-3, 1e-3), kSheet);
    EXPECT_FALSE(BodyShell(free).isHeld());
    EXPECT_FALSE(BodyShell(free).under({0, 0, 0}, {0, 0, 1}, 4e-3));
    EXPECT_EQ(bodyShellOf(free), nullptr);

    auto points = disc(20e-3, 1e-3);
    for (const glm::dvec3& p : disc(20e-3, 1e-3)) points.push_back(p + glm::dvec3(0.1, 0, 0));
    const SoftObject two = heldWhere(objectOf(points, kSheet), [](const glm::dvec3& p) { return p.x < -15e-3; });
    const BodyShell  body(two);
    EXPECT_TRUE(body.isHeld());
    EXPECT_TRUE(body.under({0, 0, 0}, {0, 0, 1}, 4e-3));
    EXPECT_FALSE(body.under({0.1, 0, 0}, {0, 0, 1}, 4e-3)) << "the other piece hangs on nothing";
}

TEST(BodyShell, IsMadeOnceForEachStiffness)
{
    const SoftObject object =
        heldWhere(objectOf(disc(20e-3, 1e-3), kSheet), [](const glm::dvec3& p) { return p.x < -15e-3; });
    const auto first = bodyShellOf(object);
    ASSERT_TRUE(first);
    EXPECT_EQ(bodyShellOf(SoftObject(object)), first) << "a copy is the same object";
    const auto painted = bodyShellOf(object.repainted(std::vector<double>(object.size(), 2 * kModulus)));
    ASSERT_NE(painted, first);
    EXPECT_NEAR(painted->under({0, 0, 0}, {0, 0, 1}, 4e-3)->give / first->under({0, 0, 0}, {0, 0, 1}, 4e-3)->give, 0.5,
                1e-9);
}

} // namespace
} // namespace palp
