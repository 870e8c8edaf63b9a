#include "engine/chart/sphere_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/chart/sphere_fit_points.h"

namespace palp {
namespace {

using Points = std::vector<glm::dvec3>;

struct Sphere {
    glm::dvec3 centre; ///< [m]
    double     radius; ///< [m]
    double     misfit; ///< [m] root mean square distance of the points
};

// Pratt's fit in 60-digit arithmetic, rounded to 16 digits (the misfit to 8).
constexpr Sphere kExactTruth{{1, -2, 3}, 2.5, 0};
constexpr Sphere kNoisySphereTruth{
    {0.9994207446313885, -1.993629829565762, 3.004456045187876}, 2.500846638896404, 0.027948537};
constexpr Sphere kNoisyCap60Truth{
    {0.2984758221473613, -0.1009726037267385, 0.6984079748074026}, 1.202082885834199, 0.0055911379};
constexpr Sphere kNoisyCap10Truth{
    {10.01316215275065, 19.99919572228178, -15.00114064543386}, 4.986932406463281, 0.0011237714};

/// Points spread evenly (golden angle) over the cap of half angle `angle` [rad] about +z.
Points capPoints(std::size_t count, const glm::dvec3& centre, double radius, double angle)
{
    Points       points;
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
    for (std::size_t i = 0; i < count; ++i) {
        // 1 - cos, so that the sag of a cap of huge radius keeps its digits: the pole is added last.
        const double drop = 2 * std::pow(std::sin(angle / 2), 2) * (double(i) + 0.5) / double(count);
        const double away = std::sqrt(drop * (2 - drop)), phi = turn * double(i);
        points.push_back(centre + glm::dvec3(0, 0, radius) +
                         radius * glm::dvec3(away * std::cos(phi), away * std::sin(phi), -drop));
    }
    return points;
}

Points wholeSphere(std::size_t count, const Sphere& sphere)
{
    return capPoints(count, sphere.centre, sphere.radius, std::numbers::pi);
}

/// 11 x 11 points of pitch 0.1 m on the plane with this unit normal at distance 0.5 m from `shift`.
Points planePoints(const glm::dvec3& normal, const glm::dvec3& shift = {})
{
    const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.9, -0.2)));
    const glm::dvec3 along  = glm::cross(normal, across);
    Points           points;
    for (int i = -5; i <= 5; ++i)
        for (int j = -5; j <= 5; ++j) points.push_back(shift + 0.5 * normal + 0.1 * i * across + 0.1 * j * along);
    return points;
}

Points ringPoints(std::size_t count, double radius, const glm::dvec3& centre)
{
    const glm::dvec3 a = glm::normalize(glm::dvec3(1, 2, -1)), b = glm::normalize(glm::cross(a, glm::dvec3(0, 1, 3)));
    Points           points;
    for (std::size_t i = 0; i < count; ++i) {
        const double phi = 2 * std::numbers::pi * double(i) / double(count);
        points.push_back(centre + radius * (std::cos(phi) * a + std::sin(phi) * b));
    }
    return points;
}

template <typename Change>
Points changed(Points points, Change change)
{
    std::transform(points.begin(), points.end(), points.begin(), change);
    return points;
}

template <std::size_t N>
Points listed(const std::array<glm::dvec3, N>& points)
{
    return {points.begin(), points.end()};
}

void expectSphere(const SphereFitResult& result, const Sphere& truth, double relative, const char* because)
{
    ASSERT_EQ(result.outcome, FitOutcome::sphere) << name(result.outcome);
    EXPECT_NEAR(result.fit.radius(), truth.radius, relative * truth.radius) << because;
    EXPECT_LE(glm::distance(result.fit.centre(), truth.centre), relative * truth.radius) << because;
}

/// The paper's five coefficients u0..u4 about the world's origin.
struct PaperCoefficients {
    double     u0;
    glm::dvec3 u123;
    double     u4;

    explicit PaperCoefficients(const SphereFit& fit)
        : u0(fit.curvature / 2), u123(fit.gradient - fit.curvature * fit.reference),
          u4(0.5 * fit.curvature * glm::dot(fit.reference, fit.reference) - glm::dot(fit.gradient, fit.reference) +
             fit.offset)
    {
    }
};

/// Curvature [1/m] as the paper computes it: QZ on (design^T design, C) of centred and scaled points.
double curvatureByQz(const Points& points)
{
    glm::dvec3 mean{};
    for (const glm::dvec3& p : points) mean += p / double(points.size());
    double square = 0;
    for (const glm::dvec3& p : points) square += glm::dot(p - mean, p - mean) / double(points.size());
    const double scale = std::sqrt(square);

    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero(), constraint = normal;
    for (const glm::dvec3& p : points) {
        const glm::dvec3 x   = (p - mean) / scale;
        const auto       row = (Eigen::Matrix<double, 5, 1>() << glm::dot(x, x), x.x, x.y, x.z, 1).finished();
        normal += row * row.transpose();
    }
    constraint.diagonal() << 0, 1, 1, 1, 0;
    constraint(0, 4) = constraint(4, 0) = -2;
    const Eigen::GeneralizedEigenSolver<Eigen::Matrix<double, 5, 5>> qz(normal, constraint);

    double smallest = std::numeric_limits<double>::infinity(), curvature = 0;
    for (int i = 0; i < 5; ++i) {
        const Eigen::Matrix<double, 5, 1> u     = qz.eigenvectors().col(i).real();
        const double                      eta   = qz.alphas()[i].real() / qz.betas()[i];
        const double                      value = u.dot(constraint * u);
        if (value <= 0 || std::abs(eta) >= smallest) continue;
        smallest  = std::abs(eta);
        curvature = 2 * std::abs(u[0]) / std::sqrt(value) / scale;
    }
    return curvature;
}

TEST(SphereFit, ExactSphereIsFoundToRounding)
{
    const auto result = fitSphere(wholeSphere(200, kExactTruth));

    expectSphere(result, kExactTruth, 1e-14, "50 rounding units: the points themselves are rounded");
    EXPECT_LE(result.fit.misfit, 1e-15) << "rounding of the points";
}

TEST(SphereFit, NoisySphereMatchesSixtyDigitFit)
{
    const auto result = fitSphere(testing::kNoisySphere);

    expectSphere(result, kNoisySphereTruth, 1e-14, "well conditioned; 50 rounding units");
    EXPECT_NEAR(result.fit.misfit, kNoisySphereTruth.misfit, 5e-10) << "last printed digit";
}

TEST(SphereFit, NoisyCapOfSixtyDegreesMatchesSixtyDigitFit)
{
    const auto result = fitSphere(testing::kNoisyCap60);

    expectSphere(result, kNoisyCap60Truth, 2e-14, "the curvature amplifies rounding by about ten");
    EXPECT_NEAR(result.fit.misfit, kNoisyCap60Truth.misfit, 5e-11) << "last printed digit";
}

TEST(SphereFit, NoisyCapOfTenDegreesFarFromTheOriginMatchesSixtyDigitFit)
{
    const auto result = fitSphere(testing::kNoisyCap10);

    expectSphere(result, kNoisyCap10Truth, 1e-13,
                 "30 times rounding of 27 m over the sag of 0.08 m would be 1e-13; uncentred it is 2.6e-8");
    EXPECT_NEAR(result.fit.misfit, kNoisyCap10Truth.misfit, 5e-11) << "last printed digit";
}

TEST(SphereFit, CoefficientsExchangedAsThePaperPrintsThemGiveItsWrongSphere)
{
    const struct {
        Points points;
        Sphere printed; ///< what eq. 3 as printed makes of the points, to the eight digits of the source
        Sphere truth;
    } cases[] = {
        {wholeSphere(200, kExactTruth), {{0.12903226, -0.25806452, 0.38709677}, 0.32258065, 0}, kExactTruth},
        {listed(testing::kNoisySphere), {{0.12902538, -0.25737792, 0.38787575}, 0.32285969, 0}, kNoisySphereTruth},
        {listed(testing::kNoisyCap60), {{-0.3478957, 0.11769106, -0.81404627}, 1.4011167, 0}, kNoisyCap60Truth},
        {listed(testing::kNoisyCap10), {{0.01429643, 0.028554127, -0.021418085}, 0.0071201615, 0}, kNoisyCap10Truth}};
    for (const auto& [points, printed, truth] : cases) {
        const auto              result = fitSphere(points);
        const PaperCoefficients u(result.fit);
        const double            root = std::sqrt(glm::dot(u.u123, u.u123) - 4 * u.u0 * u.u4);

        const glm::dvec3 right = -u.u123 / (2 * u.u0), wrong = -u.u123 / (2 * u.u4);

        EXPECT_LE(glm::distance(right, truth.centre), 1e-9 * truth.radius)
            << "uncentring the coefficients costs digits";
        EXPECT_NEAR(root / (2 * std::abs(u.u0)), truth.radius, 1e-9 * truth.radius);
        EXPECT_LE(glm::distance(wrong, printed.centre), 2e-8) << "eight digits";
        EXPECT_NEAR(root / (2 * std::abs(u.u4)), printed.radius, 2e-7 * printed.radius) << "eight digits";
        EXPECT_GT(glm::distance(result.fit.centre(), printed.centre), 0.1 * truth.radius) << "the mistake would show";
    }
}

TEST(SphereFit, AgreesWithQzOnTheNormalMatrix)
{
    std::mt19937                     random(7);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 200; ++trial) {
        const double angle = 0.2 + 0.1 * (trial % 29), noise = std::pow(10.0, -1 - trial % 5);
        const Points points = changed(capPoints(40 + std::size_t(trial), {1, 2, 3}, 1.5, angle), [&](glm::dvec3 p) {
            return p + noise * glm::dvec3(normal(random), normal(random), normal(random));
        });

        const auto result = fitSphere(points);

        ASSERT_TRUE(result.usable());
        EXPECT_NEAR(result.fit.curvature, curvatureByQz(points), 1e-11)
            << "the normal matrix squares a condition of about 100; angle " << angle << ", noise " << noise;
    }
}

TEST(SphereFit, PlanarPointsAreAPlaneWithTheRightNormal)
{
    std::mt19937                     random(11);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 300; ++trial) {
        const glm::dvec3 n      = trial == 0  ? glm::dvec3(1, 2, 2) / 3.0
                                  : trial < 4 ? glm::dvec3(trial == 1, trial == 2, trial == 3)
                                              : glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const double     far    = trial < 4 ? 0 : std::pow(10.0, trial % 7 - 1); // [m]
        const glm::dvec3 shift  = far * glm::dvec3(normal(random), normal(random), normal(random));
        const double     unit   = 2e-16 * std::max(1.0, 10 * far); // [1] rounding of the points over their extent
        const Points     points = planePoints(n, shift);

        const auto result = fitSphere(points);

        ASSERT_EQ(result.outcome, FitOutcome::plane) << trial << ": curvature " << result.fit.curvature;
        EXPECT_EQ(result.fit.curvature, 0);
        EXPECT_EQ(result.fit.radius(), std::numeric_limits<double>::infinity());
        EXPECT_NEAR(std::abs(glm::dot(result.fit.gradient, n)), 1, 1e-15);
        EXPECT_LE(glm::length(glm::cross(result.fit.gradient, n)), 10 * unit);
        EXPECT_NEAR(std::abs(result.fit.signedDistance(shift)), 0.5, 20 * unit);
        EXPECT_LE(result.fit.misfit, 5 * unit);
        const glm::dvec3 g = result.fit.gradient;
        EXPECT_GT(g[std::abs(g.x) >= std::max(std::abs(g.y), std::abs(g.z)) ? 0
                    : std::abs(g.y) >= std::abs(g.z)                        ? 1
                                                                            : 2],
                  0)
            << "the side is chosen by rule, not by rounding";
    }
}

TEST(SphereFit, NoisyPlaneIsTheLeastSquaresPlaneWithinItsNoise)
{
    std::mt19937                     random(5);
    std::normal_distribution<double> normal;
    const double                     noise = 1e-5; // [m]
    const glm::dvec3                 n     = glm::dvec3(1, 2, 2) / 3.0;
    const Points points = changed(planePoints(n), [&](glm::dvec3 p) { return p + noise * normal(random) * n; });

    const auto result = fitSphere(points);

    ASSERT_TRUE(result.usable());
    EXPECT_LE(result.fit.curvature, 5e-4) << "5 m noise / (extent^2 sqrt n), extent 0.45 m";
    EXPECT_NEAR(result.fit.misfit, noise, 0.3 * noise) << "121 samples";
}

TEST(SphereFit, PointsOnOneCircleAreARing)
{
    for (const double radius : {1e-6, 1.0, 1e6})
        for (const std::size_t count : {4u, 5u, 12u, 1000u, 20000u})
            for (const double distance : {0.0, 1.0, 1e3}) {
                const auto result =
                    fitSphere(ringPoints(count, radius, distance * radius * glm::dvec3(0.3, -0.5, 0.8)));
                EXPECT_EQ(result.outcome, FitOutcome::ring)
                    << name(result.outcome) << " for radius " << radius << ", " << count << " points at " << distance;
                EXPECT_FALSE(result.usable());
            }
}

TEST(SphereFit, NarrowBandIsStillASphere)
{
    for (const double width :
         {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) { // [m] of a band about the equator of a unit sphere
        Points points;
        for (int i = 0; i < 90; ++i) {
            const double phi = 0.07 * i, z = width * (i % 3 - 1) + 0.3;
            points.emplace_back(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z);
        }

        expectSphere(fitSphere(points), {{}, 1, 0}, 20 * 2.2e-16 / width,
                     "rounding over width; the normal matrix would lose it twice");
    }
}

TEST(SphereFit, PointsOnOneLineAreALine)
{
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const double distance : {0.0, 1.0, 1e3}) {
            Points points;
            for (int i = 0; i < 50; ++i)
                points.push_back(scale * (distance * glm::dvec3(1, 0.7, -3) + 0.1 * i * i * glm::dvec3(1, -2, 0.3)));

            EXPECT_EQ(fitSphere(points).outcome, FitOutcome::line) << scale << ", " << distance;
        }
}

TEST(SphereFit, FewerThanFourDistinctPointsAreTooFew)
{
    EXPECT_EQ(fitSphere({}).outcome, FitOutcome::tooFewPoints);
    EXPECT_EQ(fitSphere(Points{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}).outcome, FitOutcome::tooFewPoints);
    EXPECT_EQ(fitSphere(Points(1000, {1, 2, 3})).outcome, FitOutcome::tooFewPoints);
    EXPECT_EQ(fitSphere(Points{{1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}}).outcome,
              FitOutcome::tooFewPoints);
    EXPECT_FALSE(SphereFitResult{}.usable());
}

TEST(SphereFit, FourPointsThatAreNotPlanarHaveTheirCircumsphere)
{
    const Points points{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {-3, 0, 0}};

    expectSphere(fitSphere(points), {{}, 3, 0}, 1e-14, "exact data");
}

TEST(SphereFit, RepeatedPointsOnlyCount)
{
    Points twice = listed(testing::kNoisyCap60);
    twice.insert(twice.end(), testing::kNoisyCap60.begin(), testing::kNoisyCap60.end());

    const auto result = fitSphere(twice);

    expectSphere(result, kNoisyCap60Truth, 2e-14, "the same mean, twice");
    EXPECT_NEAR(result.fit.misfit, kNoisyCap60Truth.misfit, 5e-11);
}

TEST(SphereFit, IsTheSameAtEveryScale)
{
    for (const double scale : {1e-150, 1e-6, 1e-3, 1e3, 1e6, 1e150}) {
        const auto result = fitSphere(changed(listed(testing::kNoisyCap60), [&](glm::dvec3 p) { return scale * p; }));

        expectSphere(result, {scale * kNoisyCap60Truth.centre, scale * kNoisyCap60Truth.radius, 0}, 2e-14,
                     "scaling rounds each coordinate once");
        EXPECT_NEAR(result.fit.misfit, scale * kNoisyCap60Truth.misfit, 1e-7 * scale * kNoisyCap60Truth.misfit);
    }
}

TEST(SphereFit, IsTheSameAThousandRadiiAway)
{
    const glm::dvec3 shift(800, -1500, 600); // [m]
    const auto       result = fitSphere(changed(listed(testing::kNoisyCap60), [&](glm::dvec3 p) { return p + shift; }));

    expectSphere(result, {kNoisyCap60Truth.centre + shift, kNoisyCap60Truth.radius, 0}, 2e-12,
                 "coordinates of 1500 m are rounded to 2e-13 m, and there are 300 of them");
}

TEST(SphereFit, TurnsWithThePoints)
{
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, -2, 0.5));
    const double     c = std::cos(1.1), s = std::sin(1.1);
    const auto       turned = [&](const glm::dvec3& p) {
        return c * p + s * glm::cross(axis, p) + (1 - c) * glm::dot(axis, p) * axis;
    };

    const auto result = fitSphere(changed(listed(testing::kNoisyCap60), turned));

    expectSphere(result, {turned(kNoisyCap60Truth.centre), kNoisyCap60Truth.radius, 0}, 5e-14,
                 "turning rounds each coordinate a few times");
}

TEST(SphereFit, CurvatureGoesContinuouslyToThePlane)
{
    for (double radius = 1e3; radius < 2e12; radius *= 10) { // [m], for a cap of radius 1 m
        const auto result = fitSphere(capPoints(500, {0, 0, -radius}, radius, 1 / radius));

        ASSERT_EQ(result.outcome, FitOutcome::sphere) << radius;
        EXPECT_NEAR(result.fit.curvature * radius, 1, 1e-15 * radius) << "rounding moves curvature by 1e-15 / m";
        EXPECT_NEAR(result.fit.normal({0, 0, 0}).z, 1, 1e-15);
        EXPECT_NEAR(result.fit.signedDistance({0, 0, 0}), 0, 1e-15);
        EXPECT_NEAR(result.fit.signedDistance({0, 0, 0.25}), 0.25, 1e-15);
    }
    const auto flat = fitSphere(capPoints(500, {0, 0, -1e18}, 1e18, 1e-18));
    EXPECT_EQ(flat.outcome, FitOutcome::plane) << "a sag of 5e-19 m";
}

TEST(SphereFit, NonFinitePointIsAContractViolationThatNamesIt)
{
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Points points   = wholeSphere(10, kExactTruth);
        points[7].y     = bad;
        std::string why = "nothing thrown";
        try {
            (void)fitSphere(points);
        } catch (const ContractViolation& violation) {
            why = violation.what();
        }
        EXPECT_NE(why.find("point 7 of 10"), std::string::npos) << why;
    }
}

TEST(SphereFit, SignedDistanceNormalAndFootAreThoseOfTheSphere)
{
    std::mt19937                     random(3);
    std::normal_distribution<double> normal;
    const SphereFit                  fit = fitSphere(wholeSphere(200, kExactTruth)).fit;
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 p      = kExactTruth.centre + 4.0 * glm::dvec3(normal(random), normal(random), normal(random));
        const glm::dvec3 radial = glm::normalize(p - kExactTruth.centre);
        const double     depth  = glm::distance(p, kExactTruth.centre) - kExactTruth.radius;

        EXPECT_NEAR(fit.signedDistance(p), depth, 2e-14) << "rounding at 10 m";
        EXPECT_LE(glm::distance(fit.normal(p), radial), 1e-13) << "rounding over the distance from the centre";
        EXPECT_LE(glm::distance(fit.foot(p), kExactTruth.centre + kExactTruth.radius * radial), 3e-13);
    }
    EXPECT_NEAR(fit.signedDistance(kExactTruth.centre), -2.5, 1e-14);
    const SphereFit unit{{}, 1, {0, 0, 1}, 0, 0};
    EXPECT_NEAR(glm::length(unit.normal(unit.centre())), 1, 1e-15) << "some unit vector, not a quotient of zeros";
}

TEST(SphereFit, SignedDistanceKeepsItsDigitsForTinyCurvature)
{
    for (const double curvature : {0.0, 1e-15, 1e-12, 1e-9, 1e-6}) { // [1/m]
        const SphereFit  fit{{}, curvature, {0, 0, 1}, 0, 0};
        const glm::dvec3 p(0.3, -0.4, 0.01);

        // d - r with d^2 = (r + z)^2 + 0.25:  z + 0.25 / (2 r) to first order in the curvature
        const double expected = 0.01 + 0.125 * curvature * (1 - 0.01 * curvature);
        EXPECT_NEAR(fit.signedDistance(p), expected, 1e-17 + 0.1 * std::pow(curvature, 3)) << curvature;
        EXPECT_NEAR(fit.foot(p).z, -0.125 * curvature, 3e-18 + 0.01 * curvature) << curvature;
    }
}

TEST(SphereFit, OutcomesHaveNames)
{
    EXPECT_STREQ(name(FitOutcome::sphere), "sphere");
    EXPECT_STREQ(name(FitOutcome::plane), "plane");
    EXPECT_STREQ(name(FitOutcome::tooFewPoints), "too few points");
    EXPECT_STREQ(name(FitOutcome::ring), "ring");
    EXPECT_STREQ(name(FitOutcome::line), "line");
}

} // namespace
} // namespace palp
