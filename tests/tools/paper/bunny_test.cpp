// What becomes of a bunny that is not the Stanford one: a ball with an ear, in a size of its own.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/core/contract.h"
#include "engine/core/uniform.h"
#include "engine/tools/paper/parts.h"
#include "tests/support/temporary_folder.h"

namespace palp::report {
namespace {

constexpr glm::dvec3 kEar{14e-3, 28e-3, 2.5e-3}; ///< semi-axes: wide, long, thin [m]

glm::dvec3 onSphere(Uniform& u)
{
    const double z = u(-1, 1), longitude = u(0, 2 * std::numbers::pi), s = std::sqrt(1 - z * z);
    return {s * std::cos(longitude), s * std::sin(longitude), z};
}

/// A ball of 70 mm below an ear that stands up, both skins; times a factor.
PointCloud ballWithAnEar(double factor, std::size_t points)
{
    Uniform                 uniform(1);
    std::vector<glm::dvec3> positions;
    for (std::size_t n = 0; n < points; ++n)
        positions.push_back(
            factor * (n % 3 == 0 ? 70e-3 * onSphere(uniform) : kEar * onSphere(uniform) + glm::dvec3(0, 95e-3, 0)));
    return {positions, std::vector<double>(points, 1e6), StiffnessKind::modulus};
}

struct Lobe {
    PlateSolver    solver{"host"};
    FigureRenderer renderer;
    Section        section;

    void bend(const std::filesystem::path& file)
    {
        addBunny(section, file, {.solver = solver, .renderer = renderer, .quick = true});
    }
};

TEST(Bunny, ItsEarIsFoundScaledAndBent)
{
    const TemporaryFolder folder;
    const PointCloud      cloud = ballWithAnEar(1000, 12'000); // millimetres, said to be metres
    writeCloud(folder / "ball.ply", cloud);
    Lobe run;
    run.bend(folder / "ball.ply");

    const double factor = run.section.number("bunny/factor").front();
    EXPECT_NEAR(factor, 0.2502 / cloud.bounds().diagonal(), 1e-12) << "the original's size from corner to corner";
    const auto & place = run.section.number("bunny/place"), &normal = run.section.number("bunny/normal");
    const double ear = 1000 * factor; // of the ear here, per ear above
    EXPECT_NEAR(place[0], 0, 4e-3) << "in the middle of the width";
    EXPECT_GT(place[1], ear * 95e-3) << "towards the tip";
    EXPECT_NEAR(std::abs(place[2]), ear * kEar.z, 0.4 * ear * kEar.z) << "on the skin";
    EXPECT_GT(std::abs(normal[2]), 0.95) << "out of the flat side";
    EXPECT_GT(normal[2] * place[2], 0);

    EXPECT_LT(run.section.number("bunny/free/sphere_misfit").front(), 0.3 * ear * kEar.z)
        << "one skin is nearly a sphere, both are a sphere and its opposite, off by a third of the thickness";
    EXPECT_EQ(run.section.number("bunny/clamped/deflection_of_tip").front(), 0);
    EXPECT_NEAR(run.section.number("bunny/free/deflection_of_tip").front() /
                    run.section.number("bunny/free/deflection").front(),
                2.5, 0.1)
        << "as a cantilever that is loaded in the middle";
    EXPECT_NE(run.section.text.back().find("Stanford Computer Graphics Laboratory"), std::string::npos);
    EXPECT_NE(run.section.text.back().find("scaled"), std::string::npos);
}

TEST(Bunny, AsAThinSkinItsBallIsFarStifferThanAPlate)
{
    const TemporaryFolder folder;
    writeCloud(folder / "ball.ply", ballWithAnEar(1, 40'000));
    Lobe run;
    addCurvedBunny(run.section, folder / "ball.ply", {.solver = run.solver, .renderer = run.renderer, .quick = true});
    const auto& times = run.section.number("bunny/shell_over_plate");
    ASSERT_FALSE(times.empty());
    // Under a point a sphere gives way by l^2 / (8 D) (Reissner 1946), a clamped square by 0.0056 a^2 / D: 1.8 times,
    // and less under a fingertip.
    EXPECT_GT(*std::max_element(times.begin(), times.end()), 1.4);
}

TEST(Bunny, OneOfTooFewPointsIsRefused)
{
    const TemporaryFolder folder;
    writeCloud(folder / "few.ply", ballWithAnEar(1, 900));
    Lobe run;
    EXPECT_THROW(run.bend(folder / "few.ply"), Error);
    EXPECT_THROW(run.bend(folder / "none.ply"), Error);
}

} // namespace
} // namespace palp::report
