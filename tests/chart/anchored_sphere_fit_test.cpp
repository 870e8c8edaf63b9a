#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/chart/sphere_fit.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

using Points  = std::vector<glm::dvec3>;
using Weights = std::vector<double>;

const glm::dvec3 kUtm(448000, 5.4e6, 310); // [m] where surveys have their origin

/// An anchor and points about it, with weights that fall to zero at the farthest.
struct Scene {
    glm::dvec3 anchor{};
    Points     points;
    Weights    weights;
};

glm::dvec3 randomUnit(std::mt19937& random)
{
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

double smoothWeight(double distance, double radius)
{
    const double rest = std::max(0.0, 1 - distance * distance / (radius * radius));
    return rest * rest;
}

/// Random points within `reach` [m] of the pole of a sphere that bulges along `up`, which is the anchor.
Scene capAboutPole(std::size_t count, double radius, double reach, const glm::dvec3& up, const glm::dvec3& shift,
                   double noise = 0)
{
    std::mt19937                           random(5);
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double>       normal;
    const glm::dvec3                       a = glm::normalize(glm::cross(up, glm::dvec3(0.3, 0.9, -0.2)));
    const glm::dvec3                       b = glm::cross(up, a);
    Scene                                  scene{shift, {}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        // The sag s and the distance d from the pole are related by d^2 = 2 r s.
        const double distance = reach * std::sqrt(uniform(random)), sag = distance * distance / (2 * radius);
        const double phi    = 2 * std::numbers::pi * uniform(random);
        const double across = std::sqrt(distance * distance - sag * sag);
        scene.points.push_back(shift + across * (std::cos(phi) * a + std::sin(phi) * b) -
                               (sag + noise * normal(random)) * up);
        scene.weights.push_back(smoothWeight(distance, 1.01 * reach));
    }
    return scene;
}

SphereFitResult fit(const Scene& scene)
{
    return fitSphereThrough(scene.anchor, scene.points, scene.weights);
}

/// A bowl and a hill have opposite gradients; which one a surface is does not matter here.
double angleBetweenLines(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::asin(std::min(1.0, glm::length(glm::cross(a, b))));
}

struct Answer {
    double     curvature; ///< [1/m]
    glm::dvec3 normal;
};

/// The definition: QZ on (design^T design, C) of the four unknowns, with C = diag(0, 1, 1, 1).
Answer byQz(const Scene& scene)
{
    double largest = 0;
    for (const glm::dvec3& p : scene.points) largest = std::max(largest, glm::distance(p, scene.anchor));
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero(), constraint = normal;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const glm::dvec3      x = (scene.points[i] - scene.anchor) / largest;
        const Eigen::Vector4d row(glm::dot(x, x), x.x, x.y, x.z);
        normal += scene.weights[i] * row * row.transpose();
    }
    constraint.diagonal() << 0, 1, 1, 1;
    const Eigen::GeneralizedEigenSolver<Eigen::Matrix4d> qz(normal, constraint);

    double smallest = std::numeric_limits<double>::infinity();
    Answer answer{};
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector4d u   = qz.eigenvectors().col(i).real();
        const double          eta = qz.alphas()[i].real() / qz.betas()[i];
        if (!std::isfinite(eta) || eta >= smallest) continue;
        smallest            = eta;
        const double length = u.tail<3>().norm();
        answer              = {2 * std::abs(u[0]) / length / largest, glm::dvec3(u[1], u[2], u[3]) / length};
    }
    return answer;
}

/// What is minimised, of a fit.
double objective(const Scene& scene, const glm::dvec3& normal, double curvature)
{
    double sum = 0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const glm::dvec3 x        = scene.points[i] - scene.anchor;
        const double     distance = 0.5 * curvature * glm::dot(x, x) + glm::dot(normal, x);
        sum += scene.weights[i] * distance * distance;
    }
    return sum;
}

Scene noisyScene(std::mt19937& random, double noise)
{
    std::uniform_real_distribution<double> uniform;
    Scene scene = capAboutPole(60, 0.5 + uniform(random), 0.4, randomUnit(random), {1, 2, 3}, noise);
    for (double& w : scene.weights) w *= uniform(random);
    return scene;
}

TEST(AnchoredSphereFit, AnExactSphereIsFoundToRounding)
{
    for (const double radius : {0.02, 0.05, 1.0, 50.0}) {
        const glm::dvec3 up     = glm::normalize(glm::dvec3(1, -2, 0.5));
        const auto       result = fit(capAboutPole(300, radius, 0.02, up, {0.3, -0.1, 0.2}));

        ASSERT_EQ(result.outcome, FitOutcome::sphere) << radius;
        EXPECT_NEAR(result.fit.curvature, 1 / radius, 1e-10) << "1e-16 m of rounding over the sag of reach^2 / 2";
        EXPECT_LE(glm::distance(result.fit.gradient, up), 1e-13) << "1e-16 m of rounding over the reach of 0.02 m";
        EXPECT_LE(result.fit.misfit, 2e-16) << "rounding of the points";
        EXPECT_EQ(result.fit.reference, glm::dvec3(0.3, -0.1, 0.2));
        EXPECT_EQ(result.fit.offset, 0);
        EXPECT_EQ(result.fit.signedDistance(result.fit.reference), 0) << "the anchor lies on it exactly";
    }
}

TEST(AnchoredSphereFit, AnExactSphereIsFoundWhereSurveysAre)
{
    const glm::dvec3 up     = glm::normalize(glm::dvec3(1, -2, 0.5));
    const auto       result = fit(capAboutPole(300, 2.0, 0.5, up, kUtm));

    ASSERT_EQ(result.outcome, FitOutcome::sphere);
    EXPECT_NEAR(result.fit.radius(), 2, 2e-8) << "coordinates are rounded to 5e-10 m; 300 of them see a sag of 0.06 m";
    EXPECT_LE(glm::distance(result.fit.gradient, up), 2e-9);
    EXPECT_LE(result.fit.misfit, 5e-10);
}

TEST(AnchoredSphereFit, PlanarPointsAreAPlaneAlsoWhereSurveysAre)
{
    std::mt19937 random(11);
    for (int trial = 0; trial < 300; ++trial) {
        const glm::dvec3 n     = randomUnit(random);
        const double     size  = std::pow(10.0, trial % 5 - 3); // [m]
        const double     far   = trial % 2;
        Scene            scene = capAboutPole(100, std::numeric_limits<double>::infinity(), size, n, far * kUtm);

        const auto result = fit(scene);

        ASSERT_EQ(result.outcome, FitOutcome::plane) << trial << ": curvature " << result.fit.curvature;
        const double rounding = 2e-16 + far * 1e-9 / size; // [1] of the points over their extent
        EXPECT_LE(angleBetweenLines(result.fit.gradient, n), 5 * rounding);
        EXPECT_LE(result.fit.misfit, 5 * rounding * size);
        EXPECT_EQ(result.fit.curvature, 0);
        EXPECT_EQ(result.fit.reference, scene.anchor);
    }
}

TEST(AnchoredSphereFit, AgreesWithQzOnTheDefinition)
{
    std::mt19937 random(7);
    for (int trial = 0; trial < 200; ++trial) {
        const double noise = std::pow(10.0, -1 - trial % 5);
        const Scene  scene = noisyScene(random, noise);

        const auto   result = fit(scene);
        const Answer answer = byQz(scene);

        ASSERT_TRUE(result.usable());
        EXPECT_NEAR(result.fit.curvature, answer.curvature, 1e-9)
            << "the normal matrix squares a condition of some 1000; noise " << noise;
        EXPECT_LE(angleBetweenLines(result.fit.gradient, answer.normal), 1e-10);
    }
}

TEST(AnchoredSphereFit, NoSphereThroughTheAnchorIsNearer)
{
    std::mt19937                     random(3);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 50; ++trial) {
        const Scene  scene  = noisyScene(random, 0.03);
        const auto   result = fit(scene);
        const double least  = objective(scene, result.fit.gradient, result.fit.curvature);
        for (int k = 0; k < 100; ++k) {
            const double     size   = std::pow(10.0, -1 - k % 4);
            const glm::dvec3 other  = glm::normalize(result.fit.gradient + size * randomUnit(random));
            const double     curved = result.fit.curvature + size * normal(random);
            EXPECT_LE(least, objective(scene, other, curved) * (1 + 1e-12)) << "rounding of 60 terms; step " << size;
        }
    }
}

TEST(AnchoredSphereFit, NormalOfAnEllipsoidConvergesWithSecondOrderInTheRadiusOfTheWeights)
{
    // z = height over (x, y) of the ellipsoid with half axes a, b, c, about a place where the third derivatives differ
    // from zero. The weights are what is local: the points go on beyond them.
    const double     a = 0.05, b = 0.03, c = 0.02; // [m]
    const auto       height = [&](double x, double y) { return c * std::sqrt(1 - x * x / (a * a) - y * y / (b * b)); };
    const double     x0 = 0.02, y0 = 0.01;
    const glm::dvec3 anchor(x0, y0, height(x0, y0));
    const glm::dvec3 truth = glm::normalize(glm::dvec3(x0 / (a * a), y0 / (b * b), anchor.z / (c * c)));
    const glm::dvec3 east = glm::normalize(glm::cross(truth, glm::dvec3(0.3, 0.9, -0.2))), north = cross(truth, east);

    std::array<double, 4> errors{};
    for (std::size_t k = 0; k < errors.size(); ++k) {
        const double radius = 0.008 / double(1 << k); // [m]
        Scene        scene{anchor, {}, {}};
        for (int i = -40; i <= 40; ++i)
            for (int j = -40; j <= 40; ++j) {
                // Down from the tangent plane at that place along the normal: points symmetric about the anchor.
                const glm::dvec3 start = anchor + radius / 30 * (double(i) * east + double(j) * north);
                const glm::dvec3 scale(1 / (a * a), 1 / (b * b), 1 / (c * c));
                const double     A = glm::dot(truth * scale, truth), B = glm::dot(truth * scale, start),
                             C = glm::dot(start * scale, start) - 1;
                if (B * B < A * C) continue;
                const glm::dvec3 p = start - (B - std::sqrt(B * B - A * C)) / A * truth;
                scene.points.push_back(p);
                scene.weights.push_back(smoothWeight(glm::distance(p, anchor), radius));
            }

        const auto result = fit(scene);

        ASSERT_EQ(result.outcome, FitOutcome::sphere);
        errors[k] = angleBetweenLines(result.fit.gradient, truth);
    }
    EXPECT_GT(errors[0], 1e-4) << "the ellipsoid is no sphere: there is something to converge";
    for (std::size_t k = 1; k < errors.size(); ++k) {
        const double order = std::log2(errors[k - 1] / errors[k]);
        EXPECT_NEAR(order, 2, k == 1 ? 0.3 : 0.1) << errors[k - 1] << " to " << errors[k] << ": terms of fourth order";
    }
}

TEST(AnchoredSphereFit, AFlatFaceIsFlatThoughItsBoxIsNot)
{
    // The middle of the upper face of a box of 40 x 40 x 20 mm, all sides sampled.
    Scene scene{{0, 0, 0.01}, {}, {}};
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
            for (const double side : {-1, 1}) {
                scene.points.push_back({0.001 * i, 0.001 * j, 0.01 * side});
                scene.points.push_back({0.02 * side, 0.001 * i, 0.0005 * j});
                scene.points.push_back({0.001 * i, 0.02 * side, 0.0005 * j});
            }
    for (const glm::dvec3& p : scene.points)
        scene.weights.push_back(smoothWeight(glm::distance(p, scene.anchor), 0.015));

    const auto local = fit(scene), all = fitSphere(scene.points);

    EXPECT_EQ(local.outcome, FitOutcome::plane);
    EXPECT_LE(angleBetweenLines(local.fit.gradient, {0, 0, 1}), 1e-14);
    EXPECT_GT(all.fit.curvature, 20) << "what all points make of it";
}

TEST(AnchoredSphereFit, WeightsCountAsRepeatedPointsDo)
{
    std::mt19937 random(9);
    Scene        once = noisyScene(random, 0.02), repeated{once.anchor, {}, {}};
    for (std::size_t i = 0; i < once.points.size(); ++i) {
        once.weights[i] = double(i % 4);
        for (std::size_t k = 0; k < i % 4; ++k) {
            repeated.points.push_back(once.points[i]);
            repeated.weights.push_back(1);
        }
    }

    const auto a = fit(once), b = fit(repeated);

    EXPECT_NEAR(a.fit.curvature, b.fit.curvature, 1e-12) << "rounding";
    EXPECT_LE(glm::distance(a.fit.gradient, b.fit.gradient), 1e-13);
    EXPECT_NEAR(a.fit.misfit, b.fit.misfit, 1e-14);
}

TEST(AnchoredSphereFit, PointsWithoutWeightDoNotCount)
{
    std::mt19937 random(9);
    Scene        scene = noisyScene(random, 0.02), more = scene;
    for (int i = 0; i < 10; ++i) {
        more.points.insert(more.points.begin(), 1e9 * randomUnit(random));
        more.weights.insert(more.weights.begin(), 0);
    }

    const auto a = fit(scene), b = fit(more);

    EXPECT_NEAR(a.fit.curvature, b.fit.curvature, 1e-12) << "other blocks of rows, so other rounding";
    EXPECT_NEAR(a.fit.misfit, b.fit.misfit, 1e-14);
    std::fill(scene.weights.begin() + 2, scene.weights.end(), 0.0);
    EXPECT_EQ(fit(scene).outcome, FitOutcome::tooFewPoints) << "the anchor and two points";
}

TEST(AnchoredSphereFit, MisfitIsTheWeightedRootMeanSquareDistance)
{
    std::mt19937 random(13);
    const Scene  scene  = noisyScene(random, 0.05);
    const auto   result = fit(scene);
    const double radius = result.fit.radius();
    double       sum = 0, weights = 0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const double distance = glm::distance(scene.points[i], result.fit.centre()) - radius;
        sum += scene.weights[i] * distance * distance;
        weights += scene.weights[i];
    }

    EXPECT_NEAR(result.fit.misfit, std::sqrt(sum / weights), 1e-13) << "rounding";
}

TEST(AnchoredSphereFit, MovesTurnsAndScalesWithThePoints)
{
    std::mt19937     random(17);
    const Scene      scene = noisyScene(random, 0.02);
    const auto       truth = fit(scene);
    const glm::dvec3 axis  = glm::normalize(glm::dvec3(1, -2, 0.5)), shift(800, -1500, 600);
    const double     co = std::cos(1.1), si = std::sin(1.1);
    const auto       turned = [&](const glm::dvec3& p) {
        return co * p + si * glm::cross(axis, p) + (1 - co) * glm::dot(axis, p) * axis;
    };
    struct {
        double scale, far, weight, tolerance;
    } const cases[] = {{1, 0, 1, 1e-13},     {1e-150, 0, 1, 1e-13}, {1e150, 0, 1, 1e-13}, {1, 0, 1e-305, 1e-13},
                       {1, 0, 1e307, 1e-13}, {1, 1, 1, 2e-11}}; // 1500 m are rounded to 2e-13 m, over a sag of 0.05 m
    for (const auto& [scale, far, weight, tolerance] : cases) {
        const auto changed = [&, s = scale, f = far](const glm::dvec3& p) { return s * turned(p) + f * shift; };
        Scene      other{changed(scene.anchor), {}, {}};
        for (const glm::dvec3& p : scene.points) other.points.push_back(changed(p));
        for (const double w : scene.weights) other.weights.push_back(weight * w);

        const auto result = fit(other);

        ASSERT_EQ(result.outcome, truth.outcome) << scale << ", " << far << ", " << weight;
        EXPECT_NEAR(result.fit.curvature * scale, truth.fit.curvature, tolerance * 10) << scale;
        EXPECT_LE(glm::distance(result.fit.gradient, turned(truth.fit.gradient)), tolerance) << scale;
        EXPECT_NEAR(result.fit.misfit / scale, truth.fit.misfit, tolerance) << scale;
    }
}

TEST(AnchoredSphereFit, CurvatureGoesContinuouslyToThePlane)
{
    for (double radius = 1e3; radius < 2e12; radius *= 10) { // [m], for a cap that reaches 1 m
        const auto result = fit(capAboutPole(500, radius, 1, {0, 0, 1}, {}));

        ASSERT_EQ(result.outcome, FitOutcome::sphere) << radius;
        EXPECT_NEAR(result.fit.curvature * radius, 1, 2e-15 * radius) << "rounding moves curvature by 1e-15 / m";
        EXPECT_NEAR(result.fit.normal({0, 0, 0}).z, 1, 1e-15);
    }
    EXPECT_EQ(fit(capAboutPole(500, 1e18, 1, {0, 0, 1}, {})).outcome, FitOutcome::plane) << "a sag of 5e-19 m";
}

TEST(AnchoredSphereFit, DegeneratePointsAreNamed)
{
    const auto outcome = [](const glm::dvec3& anchor, const Points& points) {
        return fitSphereThrough(anchor, points, Weights(points.size(), 0.5)).outcome;
    };
    EXPECT_EQ(outcome({1, 2, 3}, {}), FitOutcome::tooFewPoints);
    EXPECT_EQ(outcome({1, 2, 3}, Points(1000, {1, 2, 3})), FitOutcome::tooFewPoints);
    EXPECT_EQ(outcome({0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}}), FitOutcome::tooFewPoints)
        << "the anchor counts once";
    EXPECT_EQ(outcome({3, 0, 0}, {{0, 3, 0}, {0, 0, 3}, {-3, 0, 0}}), FitOutcome::sphere) << "a circumsphere";

    const glm::dvec3 a = glm::normalize(glm::dvec3(1, 2, -1)), b = glm::normalize(glm::cross(a, glm::dvec3(0, 1, 3)));
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const double far : {0.0, 1.0, 1e3}) {
            Points     line, ring;
            const auto place = [&](double x, double y) { return scale * (far * glm::dvec3(3, -5, 8) + x * a + y * b); };
            for (int i = 1; i <= 50; ++i) {
                line.push_back(place(0.1 * i * i - 30, 0));
                ring.push_back(place(std::cos(0.1 * i), std::sin(0.1 * i)));
            }
            EXPECT_EQ(outcome(place(0, 0), line), FitOutcome::line) << scale << ", " << far;
            EXPECT_EQ(outcome(place(1, 0), ring), FitOutcome::ring) << scale << ", " << far;
            EXPECT_EQ(outcome(place(0, 0), ring), FitOutcome::plane) << "a ring about the anchor is a flat disc's";
        }
}

TEST(AnchoredSphereFit, FourPointsHaveTheirCircumsphere)
{
    const Points points{{0, 3, 0}, {0, 0, 3}, {-3, 0, 0}};

    const auto result = fitSphereThrough({3, 0, 0}, points, Weights{1, 5, 0.1});

    EXPECT_NEAR(result.fit.radius(), 3, 1e-13) << "exact data, so the weights do not matter";
    EXPECT_LE(glm::length(result.fit.centre()), 1e-13);
}

TEST(AnchoredSphereFit, WhatIsNotFiniteOrNegativeIsAContractViolationThatNamesIt)
{
    const auto why = [](const Scene& scene) -> std::string {
        try {
            (void)fit(scene);
        } catch (const ContractViolation& violation) {
            return violation.what();
        }
        return "nothing thrown";
    };
    const Scene  good = capAboutPole(10, 1, 0.1, {0, 0, 1}, {});
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinite}) {
        Scene scene       = good;
        scene.points[7].y = bad;
        EXPECT_NE(why(scene).find("point 7 of 10"), std::string::npos) << why(scene);
        scene          = good;
        scene.anchor.x = bad;
        EXPECT_NE(why(scene).find("anchor"), std::string::npos) << why(scene);
    }
    for (const double bad : {nan, infinite, -1e-9}) {
        Scene scene      = good;
        scene.weights[3] = bad;
        EXPECT_NE(why(scene).find("weight 3 of 10"), std::string::npos) << why(scene);
    }
    Scene scene = good;
    scene.weights.pop_back();
    EXPECT_NE(why(scene).find("9 weights for 10 points"), std::string::npos) << why(scene);
}

} // namespace
} // namespace palp
