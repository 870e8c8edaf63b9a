#include "engine/pipeline/dent_length.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace palp {
namespace {

const Material kSheet{.thickness = 1e-3, .poissonRatio = 0.3};

/// A sphere, its points by a spiral of even density.
/// \param noise  standard deviation of the radius [m]
SoftObject sphere(double radius, double noise = 0, double stiffness = 1e6)
{
    constexpr std::size_t            kCount = 30000;
    std::mt19937                     random(1);
    std::normal_distribution<double> off(0, noise > 0 ? noise : 1);
    std::vector<glm::dvec3>          points;
    for (std::size_t n = 0; n < kCount; ++n) {
        const double z = 1 - (2 * double(n) + 1) / kCount, turn = double(n) * std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = radius + (noise > 0 ? off(random) : 0);
        points.push_back({r * std::sqrt(1 - z * z) * std::cos(turn), r * std::sqrt(1 - z * z) * std::sin(turn), r * z});
    }
    return SoftObject(PointCloud(std::move(points), std::vector<double>(kCount, stiffness), StiffnessKind::modulus),
                      kSheet);
}

/// A square sheet of 100 mm.
SoftObject sheet(const std::function<double(double, double)>& height)
{
    std::vector<glm::dvec3> points;
    for (int i = -50; i <= 50; ++i)
        for (int j = -50; j <= 50; ++j) points.push_back({i * 1e-3, j * 1e-3, height(i * 1e-3, j * 1e-3)});
    std::vector<double> stiffness(points.size(), 1e6);
    return SoftObject(PointCloud(std::move(points), std::move(stiffness), StiffnessKind::modulus), kSheet);
}

PatchSettings shell()
{
    PatchSettings settings;
    settings.theory = Theory::shell;
    return settings;
}

/// l of a sphere, Reissner 1946.
double lengthOf(double radius)
{
    return std::sqrt(radius * kSheet.thickness) / std::pow(12 * (1 - 0.09), 0.25);
}

TEST(DentLength, OfASphereIsReissners)
{
    const auto found = dentLengths(sphere(50e-3), shell());
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->typical / lengthOf(50e-3), 1, 0.01) << "quadrics of 11 mm on a sphere of 50 mm";
    EXPECT_NEAR(found->most / found->least, 1, 0.01);
    EXPECT_NEAR(found->window() / lengthOf(50e-3), 8, 0.08);

    const auto noisy = dentLengths(sphere(50e-3, 0.3 * 1.0e-3), shell()); // points are 1 mm apart
    ASSERT_TRUE(noisy);
    EXPECT_NEAR(noisy->typical / lengthOf(50e-3), 1, 0.05) << "the median of places whose curvature is off by 5 %";
}

TEST(DentLength, OfAPlateOnAFoundationIsItsOwn)
{
    PatchSettings settings;
    settings.foundation = 1e6;
    const auto found    = dentLengths(sheet([](double, double) { return 0; }), settings);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->typical / std::pow(kSheet.rigidity(1e6) / 1e6, 0.25), 1, 1e-9);
}

TEST(DentLength, MembraneAndFoundationAddUp)
{
    PatchSettings settings = shell();
    settings.foundation    = kSheet.rigidity(1e6) / std::pow(lengthOf(50e-3), 4); // as stiff as the membrane
    const auto found       = dentLengths(sphere(50e-3), settings);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->typical / lengthOf(50e-3), std::pow(0.5, 0.25), 0.01);
    settings.theory = Theory::plate;
    EXPECT_NEAR(dentLengths(sphere(50e-3), settings)->typical / lengthOf(50e-3), 1, 1e-9) << "the membrane is off";
}

TEST(DentLength, IsUnknownWhereTheSupportDecides)
{
    EXPECT_FALSE(dentLengths(sheet([](double, double) { return 0; }), shell()));
    EXPECT_FALSE(dentLengths(sheet([](double x, double) { return std::sqrt(0.07 * 0.07 - x * x); }), shell()));
    EXPECT_FALSE(dentLengths(sheet([](double x, double y) { return (x * x - y * y) / 0.2; }), shell()));
}

TEST(DentLength, DecidesTheWindowIfTheSettingsSaySo)
{
    const SoftObject object   = sphere(50e-3);
    PatchSettings    settings = shell();
    EXPECT_EQ(settledFor(object, settings).window, settings.window) << "a length stays";
    settings.windowOf           = WindowOf::dent;
    const PatchSettings settled = settledFor(object, settings);
    EXPECT_NEAR(settled.window / lengthOf(50e-3), 8, 0.08);
    EXPECT_EQ(settledFor(object, settled).window, settled.window);
    settings.footprintRadius = 15e-3;
    EXPECT_EQ(settledFor(object, settings).window, 60e-3) << "a fingertip needs room";
    settings.footprintRadius = 4e-3;
    EXPECT_EQ(settledFor(sheet([](double, double) { return 0; }), settings).window, 40e-3) << "nothing decides";
}

TEST(DentLength, OfATubeIsUnknownHoweverItsPointsAreDrawn)
{
    constexpr double kRadius  = 10e-3;
    PatchSettings    settings = shell();
    settings.windowOf         = WindowOf::dent;
    for (unsigned seed = 1; seed <= 5; ++seed) { // fits see 0.001 to 0.04 1/m along it, of either sign
        std::mt19937                           random(seed);
        std::uniform_real_distribution<double> along(-50e-3, 50e-3), turn(0, 2 * std::numbers::pi);
        std::vector<glm::dvec3>                points;
        for (int n = 0; n < 40000; ++n) {
            const double t = turn(random);
            points.emplace_back(along(random), kRadius * std::cos(t), kRadius * std::sin(t));
        }
        const SoftObject tube(PointCloud(std::move(points), std::vector<double>(40000, 1e6), StiffnessKind::modulus),
                              kSheet);
        EXPECT_FALSE(dentLengths(tube, settings)) << seed;
        EXPECT_NEAR(settledFor(tube, settings).window, 2 * kRadius, 0.15 * kRadius)
            << "what sags a quarter of its width";
    }
}

TEST(DentLength, NoWindowIsWiderThanTheObject)
{
    PatchSettings settings = shell();
    settings.windowOf      = WindowOf::dent;
    const auto windowOf    = [&](double radius) {
        return settledFor(sheet([=](double x, double y) { return -(x * x + y * y) / (2 * radius); }), settings).window;
    };
    EXPECT_NEAR(windowOf(0.2) / lengthOf(0.2), 8, 0.6)
        << "62 mm fit on 100 mm; a paraboloid bends less away from its middle";
    for (const double radius : {1.0, 2.0, 10.0}) {
        EXPECT_GT(windowOf(radius), 70e-3) << radius;
        EXPECT_LT(windowOf(radius), 100e-3) << radius;
    }
}

} // namespace
} // namespace palp
