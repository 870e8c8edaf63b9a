#include "engine/cloud/samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

TEST(Samples, EverySampleLiesInItsBoundsAndHasItsOwnNumberOfPoints)
{
    for (const Sample& sample : samples()) {
        const PointCloud cloud  = makeSample(sample, sample.points, 1);
        const Bounds     bounds = boundsOf(sample);

        EXPECT_EQ(cloud.size(), sample.points) << sample.name;
        for (int k = 0; k < 3; ++k) {
            const double slack = 0.02 * bounds.diagonal(); // height fields: corners are not always their extremes
            EXPECT_GE(cloud.bounds().low[k], bounds.low[k] - slack) << sample.name << " axis " << k;
            EXPECT_LE(cloud.bounds().high[k], bounds.high[k] + slack) << sample.name << " axis " << k;
        }
    }
}

TEST(Samples, TheSeedDecidesEveryPoint)
{
    const Sample&    sample = sampleNamed("palm");
    const PointCloud one = makeSample(sample, 1000, 7), same = makeSample(sample, 1000, 7),
                     other = makeSample(sample, 1000, 8);

    EXPECT_EQ(one.positions()[999], same.positions()[999]);
    EXPECT_NE(one.positions()[999], other.positions()[999]);
    // The standard fixes this number for the default seed's engine; ours must not drift with the library (seed 1).
    EXPECT_EQ(std::mt19937_64(1)(), 2469588189546311528ULL);
}

class RoundSamples : public testing::TestWithParam<const char*> {};

/// Points per area must not depend on the place: cut the ellipsoid by x into slices and count.
TEST_P(RoundSamples, PointsAreUniformPerArea)
{
    const Sample&    sample = sampleNamed(GetParam());
    const PointCloud cloud  = makeSample(sample, 40'000, 3);
    const glm::dvec3 axes   = boundsOf(sample).high;
    // Area of the part x < t by quadrature in the parameters (u, longitude): x = a u.
    const auto areaBelow = [&](double t) {
        constexpr int kSteps = 400;
        double        area   = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j) {
                const double u = -1 + (t + 1) * (i + 0.5) / kSteps, s = std::sqrt(1 - u * u);
                const double angle = 2 * std::numbers::pi * (j + 0.5) / kSteps;
                const double y = s * std::cos(angle), z = s * std::sin(angle);
                area += axes.x * axes.y * axes.z *
                        std::sqrt(u * u / (axes.x * axes.x) + y * y / (axes.y * axes.y) + z * z / (axes.z * axes.z)) *
                        (t + 1) / kSteps;
            }
        return area;
    };
    const double whole = areaBelow(1);
    for (double t : {-0.8, -0.3, 0.0, 0.5, 0.9}) {
        const auto   count    = std::count_if(cloud.positions().begin(), cloud.positions().end(),
                                              [&](const glm::dvec3& p) { return p.x < t * axes.x; });
        const double expected = areaBelow(t) / whole;
        const double sigma    = std::sqrt(expected * (1 - expected) / double(cloud.size()));
        EXPECT_NEAR(double(count) / double(cloud.size()), expected, 4 * sigma) << "binomial spread, 4 sigma, at " << t;
    }
}

INSTANTIATE_TEST_SUITE_P(All, RoundSamples, testing::Values("ellipsoid", "ear-lobe"),
                         [](const auto& tested) { return std::string(tested.param) == "ellipsoid" ? "ellipsoid" : "lobe"; });

TEST(Samples, TheSheetsOfTheLobeMeetAtTheRim)
{
    const glm::dvec3 axes  = boundsOf(sampleNamed("ear-lobe")).high;
    const PointCloud cloud = makeSample(sampleNamed("ear-lobe"), 20'000, 1);
    for (const glm::dvec3& p : cloud.positions())
        EXPECT_NEAR(glm::length(p / axes), 1, 1e-15) << "one ellipsoid holds both; rounding";
}

TEST(Samples, WartAndTendonsAreStifferThanTheirSurroundings)
{
    const PointCloud skin          = makeSample(sampleNamed("skin"), 20'000, 1);
    const auto [softest, stiffest] = std::minmax_element(skin.stiffness().begin(), skin.stiffness().end());
    EXPECT_NEAR(*softest, 0.3e6, 1) << "far from the wart the bump has died out";
    EXPECT_NEAR(*stiffest, 3e6, 0.1e6)
        << "one of 20 000 points lies within 0.6 mm of the middle, where the bump lost 3 %";

    const PointCloud palm  = makeSample(sampleNamed("palm"), 20'000, 1);
    const auto [low, high] = std::minmax_element(palm.stiffness().begin(), palm.stiffness().end());
    EXPECT_GT(*high / *low, 20) << "tendon x 10 over thumb / 2.5";
}

TEST(Samples, ALawReplacesTheOwnStiffness)
{
    const SpatialLaw law{
        .kind = SpatialLaw::Kind::linear, .from = 1, .to = 3, .start = {-60e-3, 0, 0}, .end = {60e-3, 0, 0}};
    const PointCloud cloud = makeSample(sampleNamed("ellipsoid"), 100, 1, law);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        EXPECT_NEAR(cloud.stiffness()[i], 2 + cloud.positions()[i].x / 60e-3, 1e-12) << "the same formula in double";
}

TEST(Samples, UnknownNamesAndAbsurdNumbersAreRefused)
{
    EXPECT_THROW((void)sampleNamed("elbow"), Error);
    EXPECT_THROW((void)makeSample(sampleNamed("sheet"), 3, 1), Error);
    EXPECT_THROW((void)makeSample(sampleNamed("sheet"), 1'000'000'000'000, 1), Error);
}

} // namespace
} // namespace palp
